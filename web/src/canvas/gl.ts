/** Helpers for WebGL2 programs. */

export class GlError extends Error {}

export function programOf(gl: WebGL2RenderingContext, vertex: string, fragment: string): WebGLProgram {
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl, gl.VERTEX_SHADER, vertex));
  gl.attachShader(program, shader(gl, gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new GlError(gl.getProgramInfoLog(program) ?? "does not link");
  }
  return program;
}

/** Whether WebGL is rendered by the CPU, as far as the browser reports it. */
export function isSoftware(gl: WebGL2RenderingContext): boolean {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const name = String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
}

function shader(gl: WebGL2RenderingContext, type: number, source: string): WebGLShader {
  const made = gl.createShader(type);
  if (!made) throw new GlError("no shader");
  gl.shaderSource(made, source);
  gl.compileShader(made);
  if (!gl.getShaderParameter(made, gl.COMPILE_STATUS) && !gl.isContextLost()) {
    throw new GlError(gl.getShaderInfoLog(made) ?? "does not compile");
  }
  return made;
}

/**
 * Indices of quads, two triangles and four corners each: with indices, each corner is computed once, not for
 * both triangles.
 */
export class QuadIndices {
  private readonly buffer: WebGLBuffer;
  private quads = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.buffer = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffer);
  }

  draw(first: number, count: number): void {
    const { gl } = this;
    gl.drawElements(gl.TRIANGLES, 6 * count, gl.UNSIGNED_INT, 6 * first * Uint32Array.BYTES_PER_ELEMENT);
  }

  /** Makes room for a number of quads. */
  grow(quads: number): void {
    if (quads <= this.quads) return;
    this.quads = quads;
    const numbers = new Uint32Array(6 * quads);
    for (let i = 0; i < quads; i++)
      numbers.set([4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3], 6 * i);
    this.gl.bufferData(this.gl.ELEMENT_ARRAY_BUFFER, numbers, this.gl.STATIC_DRAW);
  }
}

export const rowTexels = 1024;

/** A texture of a frame's floats: one texel per robot, 1024 per row. */
export class RobotTexture {
  private readonly texture: WebGLTexture;
  private rows = 0;

  constructor(private readonly gl: WebGL2RenderingContext) {
    this.texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, name, gl.NEAREST);
    }
  }

  /** Whole rows first, then a partial row, so that no padded copy is needed. */
  put(robots: Float32Array, count: number): void {
    this.grow(Math.ceil(count / rowTexels));
    const whole = Math.floor(count / rowTexels);
    if (whole > 0) this.part(robots, 0, whole, rowTexels);
    if (count > whole * rowTexels) this.part(robots, whole, 1, count - whole * rowTexels);
  }

  private part(robots: Float32Array, row: number, rows: number, columns: number): void {
    const { gl } = this;
    const from = 4 * row * rowTexels;
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, row, columns, rows, gl.RGBA, gl.FLOAT, robots, from);
  }

  private grow(rows: number): void {
    const { gl } = this;
    if (rows <= this.rows) return;
    this.rows = rows;
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, rowTexels, rows, 0, gl.RGBA, gl.FLOAT, null);
  }
}
