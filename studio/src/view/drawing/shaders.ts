// GLSL of the body. Frames reach the GPU as they came: four 16-bit numbers for each vertex.

const PLACED = /* glsl */ `
in vec4 packed;
uniform vec3 uOrigin;
uniform vec3 uScale;
uniform float uExaggeration;
vec3 placed() {
  vec3 now = uOrigin + uScale * packed.xyz;
  return position + uExaggeration * (now - position);
}
`;

export const COLORED = /* glsl */ `
uniform sampler2D uLut;
uniform vec2 uFrameRange;
uniform vec2 uRange;
// Place of a value in the range of colors: 0 to 1, or beyond.
float shareOf(float field) {
  float value = uFrameRange.x + (uFrameRange.y - uFrameRange.x) * field;
  return (value - uRange.x) / max(uRange.y - uRange.x, 1e-30);
}
vec3 colorOf(float share) {
  return texture(uLut, vec2(clamp(share, 0.002, 0.998), 0.5)).rgb;
}
// Outside of a fixed range: stripes on the screen, seen without telling colors apart.
vec3 stripedOf(float share, vec2 at) {
  vec3 base = colorOf(share);
  float beyond = max(share - 1.0, -share);
  if (beyond <= 0.01) return base;
  float stripe = step(0.5, fract((at.x + at.y) / 9.0));
  return mix(base, vec3(share > 1.0 ? 1.0 : 0.15), 0.45 * stripe);
}
`;

export const CUT = /* glsl */ `
uniform vec4 uPlane;
uniform float uSection;
bool cutAway(vec3 at) {
  return uSection > 0.5 && dot(uPlane.xyz, at) > uPlane.w;
}
`;

export const BODY_VERTEX = /* glsl */ `
${PLACED}
out vec3 vWorld;
out vec3 vView;
out float vField;
void main() {
  vWorld = placed();
  vec4 view = modelViewMatrix * vec4(vWorld, 1.0);
  vView = view.xyz;
  vField = packed.w;
  gl_Position = projectionMatrix * view;
}
`;

export const BODY_FRAGMENT = /* glsl */ `
precision highp float;
${CUT}
${COLORED}
in vec3 vWorld;
in vec3 vView;
in float vField;
uniform float uByField;
uniform vec3 uOwn;
uniform float uAlpha;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
  if (normal.z < 0.0) normal = -normal;
  // Mostly ambient: the map's colors must stay those of the legend, the light tells the shape.
  float light = 0.74 + 0.26 * max(0.0, dot(normal, normalize(vec3(0.35, 0.55, 0.75))));
  vec3 base = uOwn;
  if (uByField > 0.5) base = stripedOf(shareOf(vField), gl_FragCoord.xy);
  color = vec4(base * light * (gl_FrontFacing ? 1.0 : 0.82), uAlpha);
}
`;

export const SHEET_FRAGMENT = /* glsl */ `
precision highp float;
${CUT}
in vec3 vWorld;
uniform vec3 uOwn;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  // Threads both ways on the screen, between which the body's own color shows.
  vec2 way = vec2(gl_FragCoord.x + gl_FragCoord.y, gl_FragCoord.x - gl_FragCoord.y) / 10.0;
  vec2 near = smoothstep(0.36, 0.46, abs(fract(way) - 0.5));
  color = vec4(uOwn, mix(0.2, 0.85, max(near.x, near.y)));
}
`;

export const STENCIL_FRAGMENT = /* glsl */ `
precision highp float;
${CUT}
in vec3 vWorld;
out vec4 color;
void main() {
  if (cutAway(vWorld)) discard;
  color = vec4(0.0);
}
`;

export const EDGE_VERTEX = /* glsl */ `
${PLACED}
uniform float uVoxelSize;
uniform float uPixels;
uniform float uFade;
out vec3 vWorld;
out float vStrength;
out float vField;
void main() {
  vWorld = placed();
  vField = packed.w;
  vec4 view = modelViewMatrix * vec4(vWorld, 1.0);
  gl_Position = projectionMatrix * view;
  // Side of a voxel on the screen, in pixels; below some, edges would only darken the body.
  float side = uVoxelSize * uPixels * projectionMatrix[1][1] / gl_Position.w;
  vStrength = mix(1.0, smoothstep(3.0, 14.0, side), uFade);
}
`;

export const EDGE_FRAGMENT = /* glsl */ `
precision highp float;
${CUT}
${COLORED}
in vec3 vWorld;
in float vStrength;
in float vField;
uniform vec4 uInk;
uniform float uByField;
out vec4 color;
void main() {
  if (vStrength < 0.01 || cutAway(vWorld)) discard;
  vec3 ink = uByField > 0.5 ? colorOf(shareOf(vField)) : uInk.rgb;
  color = vec4(ink, uInk.a * vStrength);
}
`;

export const CAP_VERTEX = /* glsl */ `
out vec3 vWorld;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vWorld = world.xyz;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`;

export const CAP_FRAGMENT = /* glsl */ `
precision highp float;
uniform vec3 uCut;
out vec4 color;
void main() {
  // Hatched, as drawings mark cut material.
  float line = smoothstep(0.0, 1.2, abs(fract((gl_FragCoord.x - gl_FragCoord.y) / 11.0) - 0.5) * 11.0 - 0.2);
  color = vec4(uCut * mix(0.82, 1.0, line), 1.0);
}
`;

export const FILL_VERTEX = /* glsl */ `
in float field;
out float vField;
void main() {
  vField = field;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
`;

export const FILL_FRAGMENT = /* glsl */ `
precision highp float;
${COLORED}
in float vField;
out vec4 color;
void main() {
  color = vec4(stripedOf(shareOf(vField), gl_FragCoord.xy), 1.0);
}
`;

export const SKY_VERTEX = /* glsl */ `
out vec2 vAt;
void main() {
  vAt = position.xy * 0.5 + 0.5;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`;

export const SKY_FRAGMENT = /* glsl */ `
precision highp float;
uniform vec3 uTop;
uniform vec3 uBottom;
in vec2 vAt;
out vec4 color;
void main() {
  // A little noise hides the steps of eight bits in a slow gradient.
  float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) / 255.0;
  color = vec4(mix(uBottom, uTop, smoothstep(0.0, 1.0, vAt.y)) + noise - 0.5 / 255.0, 1.0);
}
`;

export const COPY_FRAGMENT = /* glsl */ `
precision highp float;
uniform sampler2D uPicture;
out vec4 color;
void main() {
  color = vec4(texelFetch(uPicture, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
}
`;

export const GRID_VERTEX = /* glsl */ `
out vec2 vAt;
void main() {
  vec4 world = modelMatrix * vec4(position, 1.0);
  vAt = world.xy;
  gl_Position = projectionMatrix * viewMatrix * world;
}
`;

export const GRID_FRAGMENT = /* glsl */ `
precision highp float;
in vec2 vAt;
uniform float uCell;
uniform vec2 uCenter;
uniform float uReach;
uniform vec3 uInk;
uniform float uFacing;
out vec4 color;
float lines(float cell) {
  vec2 at = vAt / cell;
  vec2 width = fwidth(at);
  vec2 near = abs(fract(at - 0.5) - 0.5) / max(width, 1e-9);
  // Cells smaller than a few pixels fade, or they would shimmer.
  float fade = 1.0 - smoothstep(0.12, 0.45, max(width.x, width.y));
  return (1.0 - min(min(near.x, near.y), 1.0)) * fade;
}
void main() {
  float far = length(vAt - uCenter) / uReach;
  float strength = max(0.38 * lines(uCell), 0.8 * lines(uCell * 5.0));
  strength *= (1.0 - smoothstep(0.25, 1.0, far)) * uFacing;
  if (strength < 0.004) discard;
  color = vec4(uInk, strength);
}
`;
