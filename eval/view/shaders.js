'use strict';
/* What viewer.js has the graphics card do: pairs of the program of corners and that of pixels. */
const HEAD = `#version 300 es
precision highp float; precision highp sampler3D;
uniform mat3 turn; uniform vec4 view; uniform vec3 stops[9];
vec3 ramp(float t) {
  float x = clamp(t, 0., 1.) * 8.; int i = min(int(x), 7);
  return mix(stops[i], stops[i + 1], x - float(i));
}
vec3 light(vec3 colour, vec3 normal) { return colour * (.62 + .42 * dot(normal, vec3(-.42, .54, .73))); }
`;
/* `cap`: the direction u of a unit vector p and the least p u, of all p of the sphere that can be seen. */
const SPHERE = [HEAD + `layout(location = 0) in vec4 sphere; layout(location = 1) in float value;
layout(location = 2) in vec4 cap; out vec2 at; flat out vec4 ball; flat out vec3 base;
float reach(float c) { /* greatest p e of the cap, c = u e */
  return c >= cap.w ? 1. : cap.w * c + sqrt((1. - cap.w * cap.w) * max(0., 1. - c * c));
}
bool looksAway(float z) { /* all of the cap, u with that component towards the eye */
  return cap.w >= 1. || (cap.w > 0. && z < -sqrt(1. - cap.w * cap.w));
}
void main() {
  vec3 u = turn * cap.xyz;
  float c = length(u.xy), across = reach(0.);
  vec2 along = c > 0. ? u.xy / c : vec2(1, 0), part = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  at = mix(-reach(-c), reach(c), part.x) * along + mix(-across, across, part.y) * vec2(-along.y, along.x);
  if (looksAway(u.z)) at = vec2(2); /* of one point nothing is drawn */
  ball = vec4(turn * sphere.xyz, sphere.w); base = ramp(value);
  gl_Position = vec4((ball.xy + at * ball.w) * view.xy + view.zw, 0, 1);
}`, HEAD + `in vec2 at; flat in vec4 ball; flat in vec3 base; out vec4 colour;
uniform bool surface; uniform sampler3D field; uniform vec3 low, size; uniform vec2 range;
void main() {
  float square = 1. - dot(at, at);
  if (square < 0.) discard;
  vec3 normal = vec3(at, sqrt(square)), place = ball.xyz + ball.w * normal, tint = base;
  gl_FragDepth = .5 - .25 * place.z;
  if (surface) tint = ramp(mix(range.x, range.y, texture(field, (place * turn - low) / size).r));
  colour = vec4(light(tint, normal) * smoothstep(-.35, .35, normal.z), 1);
}`];
const MESH = [HEAD + `layout(location = 0) in vec3 corner; layout(location = 1) in float value;
out vec3 place; out float shade;
void main() {
  place = turn * corner; shade = value;
  gl_Position = vec4(place.xy * view.xy + view.zw, -.5 * place.z, 1);
}`, HEAD + `in vec3 place; in float shade; out vec4 colour; uniform bool surface; uniform float alpha;
void main() {
  vec3 normal = normalize(cross(dFdx(place), dFdy(place)));
  vec3 base = surface ? ramp(shade) : vec3(.72, .76, .8);
  float seen = surface ? max(alpha, min(shade * 3., .9)) : alpha;
  colour = vec4(light(base, normal.z < 0. ? -normal : normal), seen);
}`];
