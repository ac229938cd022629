const head = `#version 300 es
precision highp float; precision highp int;
uniform highp sampler2D robots; uniform vec4 view; uniform float radius; uniform vec3 palette[5];
`;

/** A chevron: front at (1, 0), two tails and a notch between them; small robots have three corners, no notch. */
export const bodyVertex = `${head}
uniform int corners;
flat out vec3 colour;
const vec2 corner[4] = vec2[4](vec2(1, 0), vec2(-.8, .7), vec2(-.4, 0), vec2(-.8, -.7));
void main() {
  int robot = gl_VertexID / corners, number = gl_VertexID - robot * corners;
  if (corners == 3 && number == 2) number = 3;
  vec4 pose = texelFetch(robots, ivec2(robot & 1023, robot >> 10), 0);
  vec2 at = corner[number] * radius;
  float c = cos(pose.z), s = sin(pose.z);
  gl_Position = vec4((pose.xy + mat2(c, s, -s, c) * at) * view.xy + view.zw, 0, 1);
  colour = palette[int(pose.w)];
}`;

export const flatFragment = `#version 300 es
precision mediump float; flat in vec3 colour; out vec4 shown;
void main() { shown = vec4(colour, 1); }`;

/** A rotated square around each marked robot; the fragment shader draws the mark of its state. */
export const markVertex = `${head}
layout(location = 0) in uint number;
flat out vec3 colour; flat out int state; out vec2 at;
const vec2 corner[4] = vec2[4](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, 1));
void main() {
  int robot = int(number);
  vec4 pose = texelFetch(robots, ivec2(robot & 1023, robot >> 10), 0);
  at = corner[gl_VertexID & 3] * 1.66;
  float c = cos(pose.z), s = sin(pose.z);
  gl_Position = vec4((pose.xy + mat2(c, s, -s, c) * at * radius) * view.xy + view.zw, 0, 1);
  state = int(pose.w);
  colour = palette[state];
}`;

/** `at` is in radii; `pixel` is the size of a pixel in radii, so that lines stay visible at any size. */
export const markFragment = `#version 300 es
precision highp float;
flat in vec3 colour; flat in int state; in vec2 at; out vec4 shown; uniform float pixel;
float chevron(vec2 p) { p.y = abs(p.y); return max(dot(p - vec2(1, 0), vec2(.3624, .932)), dot(p - vec2(-.4, 0), vec2(-.8682, -.4961))); }
void main() {
  float half_line = max(.09, .75 * pixel);
  float inside = 1.;
  if (state == 1) inside = half_line - abs(length(at) - 1.5);
  else if (state == 2) inside = min(half_line * 1.3 - min(abs(at.x - at.y), abs(at.x + at.y)) * .7071, 1.6 - length(at));
  else if (state == 3) inside = -chevron(at) - max(.16, pixel);
  else if (state == 4) inside = half_line - abs(max(abs(at.x), abs(at.y)) - 1.3);
  else discard;
  float cover = clamp(inside / pixel + .5, 0., 1.);
  if (cover <= 0.) discard;
  shown = vec4(colour * cover, cover);
}`;
