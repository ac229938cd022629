import type { Frame } from "../api/frames";
import type { Range } from "../shared/robots";
import { Backdrop, type Box } from "./backdrop";
import type { Camera } from "./camera";
import { type Colours, rgb, robotColours } from "./colours";
import { isSoftware, programOf, QuadIndices, RobotTexture } from "./gl";
import { drawnRadius, type Painter } from "./painter";
import { bodyVertex, flatFragment, markFragment, markVertex } from "./shaders";

/** Below this size the notch is not visible, and one triangle suffices. */
const notched_px = 4;

/** Locations of the uniforms that all programs have. */
interface Locations {
  program: WebGLProgram;
  view: WebGLUniformLocation | null;
  radius: WebGLUniformLocation | null;
  palette: WebGLUniformLocation | null;
}

/**
 * Draws robots with WebGL2: two triangles each. The shader computes the corners from the vertex number, so
 * that a frame's floats are uploaded as received. Robots that are not clear get a mark in addition.
 */
export class PainterGl implements Painter {
  readonly isSoftware: boolean;
  private readonly body: Locations;
  private readonly corners: WebGLUniformLocation | null;
  private readonly marks: Locations;
  private readonly texture: RobotTexture;
  private readonly marked: WebGLBuffer;
  private readonly backdrop: Backdrop;
  private readonly quads: QuadIndices;
  private colours: Colours | null = null;
  private numbers = new Uint32Array(0);
  private markCount = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.isSoftware = isSoftware(gl);
    this.body = this.locations(bodyVertex, flatFragment);
    this.corners = gl.getUniformLocation(this.body.program, "corners");
    this.marks = this.locations(markVertex, markFragment);
    this.texture = new RobotTexture(gl);
    this.backdrop = new Backdrop(gl);
    this.quads = new QuadIndices(gl);
    this.marked = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.marked);
    gl.vertexAttribIPointer(0, 1, gl.UNSIGNED_INT, 0, 0);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  setColours(colours: Colours): void {
    const { gl } = this;
    this.colours = colours;
    const palette = robotColours.flatMap((name) => rgb(colours[name]));
    gl.useProgram(this.body.program);
    gl.uniform3fv(this.body.palette, palette);
    gl.useProgram(this.marks.program);
    // An empty robot is hollow, in the colour of the ground; a broken one's frame must contrast with it.
    const marks = [0, 1, 2].flatMap((i) => palette.slice(3 * i, 3 * i + 3));
    gl.uniform3fv(this.marks.palette, [...marks, ...rgb(colours.ground), ...rgb(colours["robot-mark"])]);
  }

  setStill(still: CanvasRenderingContext2D, ground: Box): void {
    const { canvas } = still;
    const picture = still.getImageData(0, 0, canvas.width, canvas.height);
    if (this.colours) this.backdrop.set(picture, ground, rgb(this.colours.ground), rgb(this.colours.outside));
  }

  paint(frame: Frame | null, ranges: Range[], camera: Camera, fresh: boolean): void {
    this.backdrop.paint();
    if (!frame) return;
    if (fresh) this.take(frame);
    this.paintBodies(frame, ranges, camera);
    if (this.markCount > 0) this.paintMarks(ranges, camera, frame.count);
  }

  private take(frame: Frame): void {
    this.texture.put(frame.robots, frame.count);
    this.quads.grow(frame.count);
    if (this.numbers.length < 4 * frame.count) this.numbers = new Uint32Array(4 * frame.count);
    this.markCount = markedOf(frame, this.numbers);
    if (this.markCount === 0) return;
    this.gl.bindBuffer(this.gl.ARRAY_BUFFER, this.marked);
    this.gl.bufferData(
      this.gl.ARRAY_BUFFER,
      this.numbers.subarray(0, 4 * this.markCount),
      this.gl.STREAM_DRAW,
    );
  }

  private paintBodies(frame: Frame, ranges: Range[], camera: Camera): void {
    const { gl, body } = this;
    gl.useProgram(body.program);
    gl.disableVertexAttribArray(0);
    this.setView(body, camera);
    for (const { kind, first, count } of ranges) {
      const radius = drawnRadius(kind.radius, camera, frame.count);
      const drawn = Math.max(0, Math.min(count, frame.count - first));
      const isSmall = radius * camera.scale < notched_px;
      gl.uniform1f(body.radius, radius);
      gl.uniform1i(this.corners, isSmall ? 3 : 4);
      if (isSmall) gl.drawArrays(gl.TRIANGLES, 3 * first, 3 * drawn);
      else if (drawn > 0) this.quads.draw(first, drawn);
    }
  }

  private paintMarks(ranges: Range[], camera: Camera, robots: number): void {
    const { gl, marks } = this;
    gl.useProgram(marks.program);
    gl.enableVertexAttribArray(0);
    gl.enable(gl.BLEND);
    this.setView(marks, camera);
    // Marks of all kinds in one call, with the size of the largest kind.
    const maxRadius = Math.max(
      0,
      ...ranges.filter((range) => range.count > 0).map(({ kind }) => kind.radius),
    );
    const radius = drawnRadius(maxRadius, camera, robots);
    gl.uniform1f(marks.radius, radius);
    gl.uniform1f(gl.getUniformLocation(marks.program, "pixel"), 1 / (radius * camera.scale));
    this.quads.draw(0, this.markCount);
    gl.disable(gl.BLEND);
  }

  private setView({ view }: Locations, { x, y, scale, width, height }: Camera): void {
    const [sx, sy] = [(2 * scale) / width, (2 * scale) / height];
    this.gl.uniform4f(view, sx, sy, -x * sx, -y * sy);
  }

  private locations(vertex: string, fragment: string): Locations {
    const program = programOf(this.gl, vertex, fragment);
    const at = (name: string) => this.gl.getUniformLocation(program, name);
    return { program, view: at("view"), radius: at("radius"), palette: at("palette") };
  }
}

/** Writes the number of each robot that is not clear, once per corner. Returns the number of these robots. */
function markedOf({ robots, count }: Frame, numbers: Uint32Array): number {
  let marked = 0;
  for (let i = 0; i < count; i++) {
    if (robots[4 * i + 3] === 0) continue;
    numbers.fill(i, 4 * marked, 4 * marked + 4);
    marked += 1;
  }
  return marked;
}
