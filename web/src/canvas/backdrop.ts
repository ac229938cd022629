import { programOf } from "./gl";

/** A rectangle in pixels of the canvas, y down: left, top, width, height. */
export type Box = [number, number, number, number];

const tile_px = 4;

const vertex = `#version 300 es
precision highp float; layout(location = 1) in vec2 at; uniform vec2 size;
void main() { gl_Position = vec4(at / size * vec2(2, -2) + vec2(-1, 1), 0, 1); }`;

const fragment = `#version 300 es
precision highp float; uniform highp sampler2D still; uniform vec2 size; out vec4 shown;
void main() { shown = texelFetch(still, ivec2(gl_FragCoord.x, size.y - gl_FragCoord.y), 0); }`;

/**
 * Draws the still layers below the robots on the same canvas. Without a graphics card, a second canvas below
 * a transparent one costs 10 ms per frame, as every pixel is blended. So the two plain colours, of the ground
 * and outside it, are drawn by clearing, which is nearly free, and only tiles with other colours are drawn
 * from the picture.
 */
export class Backdrop {
  private readonly program: WebGLProgram;
  private readonly texture: WebGLTexture;
  private readonly corners: WebGLBuffer;
  private readonly size: WebGLUniformLocation | null;
  private count = 0;
  private ground: Box = [0, 0, 0, 0];
  private plain: [number[], number[]] = [[], []];

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.program = programOf(gl, vertex, fragment);
    this.size = gl.getUniformLocation(this.program, "size");
    gl.useProgram(this.program);
    gl.uniform1i(gl.getUniformLocation(this.program, "still"), 1);
    this.texture = gl.createTexture();
    this.corners = gl.createBuffer();
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
    gl.activeTexture(gl.TEXTURE0);
  }

  /** Sets the picture and its two plain colours (red, green, blue; 0 to 1). */
  set(picture: ImageData, ground: Box, groundColour: number[], outsideColour: number[]): void {
    const { gl } = this;
    this.ground = ground;
    this.plain = [groundColour, outsideColour];
    gl.activeTexture(gl.TEXTURE1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.activeTexture(gl.TEXTURE0);
    const strips = stripsOf(picture, ground, packed(groundColour), packed(outsideColour));
    this.count = strips.length;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ARRAY_BUFFER, cornersOf(strips), gl.DYNAMIC_DRAW);
    gl.vertexAttribPointer(1, 2, gl.FLOAT, false, 0, 0);
  }

  paint(): void {
    const { gl } = this;
    const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const [left, top, wide, high] = this.ground;
    gl.viewport(0, 0, width, height);
    this.clear(this.plain[1]);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(left, height - top - high, wide, high);
    this.clear(this.plain[0]);
    gl.disable(gl.SCISSOR_TEST);
    if (this.count === 0) return;
    gl.useProgram(this.program);
    gl.uniform2f(this.size, width, height);
    gl.enableVertexAttribArray(1);
    gl.drawArrays(gl.TRIANGLES, 0, 6 * this.count);
    gl.disableVertexAttribArray(1);
  }

  private clear([red = 0, green = 0, blue = 0]: number[]): void {
    this.gl.clearColor(red, green, blue, 1);
    this.gl.clear(this.gl.COLOR_BUFFER_BIT);
  }
}

/** Boxes of tiles that differ from the plain colour at their position. */
export function stripsOf(
  { width, height, data }: Pick<ImageData, "width" | "height" | "data">,
  ground: Box,
  groundColour: number,
  outsideColour: number,
): Box[] {
  const pixels = new Uint32Array(data.buffer, data.byteOffset, width * height);
  const strips: Box[] = [];
  /** Index in `strips` of the strips that end in the row above, by left side and width. */
  let above = new Map<string, number>();
  for (let top = 0; top < height; top += tile_px) {
    const high = Math.min(tile_px, height - top);
    const row = runsOf(pixels, width, [0, top, width, high], ground, groundColour, outsideColour);
    const here = new Map<string, number>();
    for (const run of row) {
      const key = `${run[0]} ${run[2]}`;
      const place = above.get(key) ?? strips.length;
      const taller = strips[place];
      if (taller) taller[3] += high;
      else strips.push(run);
      here.set(key, place);
    }
    above = here;
  }
  return strips;
}

/** The runs of tiles in a row that must be drawn. */
function runsOf(
  pixels: Uint32Array,
  width: number,
  [, top, , high]: Box,
  ground: Box,
  groundColour: number,
  outsideColour: number,
): Box[] {
  const runs: Box[] = [];
  let isRun = false;
  for (let left = 0; left < width; left += tile_px) {
    const tile: Box = [left, top, Math.min(tile_px, width - left), high];
    const last = runs.at(-1);
    const isDrawn = !isCleared(pixels, width, tile, ground, groundColour, outsideColour);
    if (isDrawn && isRun && last) last[2] += tile[2];
    else if (isDrawn) runs.push(tile);
    isRun = isDrawn;
  }
  return runs;
}

/** Whether a tile has only the plain colour that clearing gives it. */
function isCleared(
  pixels: Uint32Array,
  width: number,
  tile: Box,
  ground: Box,
  groundColour: number,
  outsideColour: number,
): boolean {
  if (within(tile, ground)) return isPlain(pixels, width, tile, groundColour);
  return !meets(tile, ground) && isPlain(pixels, width, tile, outsideColour);
}

function within([left, top, wide, high]: Box, [x, y, w, h]: Box): boolean {
  return left >= x && top >= y && left + wide <= x + w && top + high <= y + h;
}

function meets([left, top, wide, high]: Box, [x, y, w, h]: Box): boolean {
  return left < x + w && top < y + h && left + wide > x && top + high > y;
}

function isPlain(pixels: Uint32Array, width: number, [left, top, wide, high]: Box, plain: number): boolean {
  for (let y = top; y < top + high; y++) {
    for (let i = y * width + left; i < y * width + left + wide; i++) if (pixels[i] !== plain) return false;
  }
  return true;
}

function cornersOf(strips: Box[]): Float32Array {
  const corners = new Float32Array(12 * strips.length);
  strips.forEach(([left, top, wide, high], i) => {
    const [right, bottom] = [left + wide, top + high];
    corners.set([left, top, right, top, right, bottom, left, top, right, bottom, left, bottom], 12 * i);
  });
  return corners;
}

/** A pixel of an `ImageData` as one integer (little-endian, as on all current machines). */
export function packed([red = 0, green = 0, blue = 0]: number[]): number {
  const byte = (value: number) => Math.round(255 * value);
  return ((255 << 24) | (byte(blue) << 16) | (byte(green) << 8) | byte(red)) >>> 0;
}
