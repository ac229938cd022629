import type { Glyph, Point, Shape } from "../api/protocol";

/** The outline of a shape within a unit circle, y down: a closed polygon, or open lines. */
interface Outline {
  closed: boolean;
  lines: Point[][];
}

const outlines: Record<Shape, Outline> = {
  circle: polygon(48),
  triangle: polygon(3),
  diamond: polygon(4),
  hexagon: polygon(6),
  square: {
    closed: true,
    lines: [
      [
        [-1, -1],
        [1, -1],
        [1, 1],
        [-1, 1],
      ],
    ],
  },
  cross: {
    closed: false,
    lines: [
      [
        [-0.8, -0.8],
        [0.8, 0.8],
      ],
      [
        [-0.8, 0.8],
        [0.8, -0.8],
      ],
    ],
  },
  tick: {
    closed: false,
    lines: [
      [
        [-0.9, 0],
        [-0.3, 0.7],
        [0.9, -0.8],
      ],
    ],
  },
};

/** A regular polygon with a corner at the top. */
function polygon(corners: number): Outline {
  const corner = (_: unknown, i: number): Point => {
    const angle = (2 * Math.PI * i) / corners;
    return [Math.sin(angle), -Math.cos(angle)];
  };
  return { closed: true, lines: [Array.from({ length: corners }, corner)] };
}

/** The radius of a glyph in pixels, at a scale in pixels per unit of the world. */
export function radiusOf({ radius_px, radius }: Glyph, scale: number): number {
  return Math.max(radius_px, (radius ?? 0) * scale);
}

/** The lines of a glyph around a place, in pixels. */
export function linesOf(shape: Shape, [x, y]: Point, radius: number): Outline {
  const { closed, lines } = outlines[shape];
  const there = ([right, down]: Point): Point => [x + radius * right, y + radius * down];
  return { closed, lines: lines.map((points) => points.map(there)) };
}

/** The same as a path of SVG. */
export function svgPath(shape: Shape, at: Point, radius: number): string {
  const { closed, lines } = linesOf(shape, at, radius);
  const of = (points: Point[]) =>
    `M${points.map((point) => point.map((of) => of.toFixed(2)).join(" ")).join("L")}`;
  return lines.map((points) => of(points) + (closed ? "z" : "")).join("");
}
