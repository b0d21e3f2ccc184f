// Shaders of the map: points, and the pass that shades edges by depth. They are short, with one way
// to each color: without a graphics card the first image waits until they are compiled.

/** What the vertex shaders of all points have in common: cut by planes, sized, shaded, discs. */
export const LAID_POINT = `
precision highp float;
uniform mat4 projectionMatrix;
uniform mat3 turn;       // from the map to the eye
uniform float focal;     // pixels of a meter at a meter's distance; parallel: at any distance
uniform bool parallel;
uniform vec2 sizes;      // smallest and largest point [px]
uniform vec4 planes[12];
uniform int planeCount;
#ifdef DISCS
flat out vec3 middle;    // of the point, from the eye [m]
flat out vec4 disc;      // its normal, and its radius [m]; 0 = a square of a few pixels
#endif

// Places a point of the map that the eye sees there; returns how bright it is.
float lay(vec3 place, vec3 seen, vec3 normal, float wide) {
  float inside = 0.0;
  for (int k = 0; k < planeCount; k++) inside = min(inside, dot(planes[k], vec4(place, 1.0)));
  gl_Position = inside < 0.0 ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * vec4(seen, 1.0);
  float away = parallel ? 1.0 : max(-seen.z, 0.01);
  gl_PointSize = clamp(wide * focal / away, sizes.x, sizes.y);
  vec3 toEye = parallel ? vec3(0.0, 0.0, 1.0) : normalize(-seen);
  float length2 = dot(normal, normal);
  bool known = length2 > 0.2;
  vec3 n = known ? turn * normal * inversesqrt(length2) : toEye;
  float facing = dot(n, toEye);
#ifdef DISCS
  n = facing < 0.0 ? -n : n;
  n += max(0.35 - abs(facing), 0.0) * toEye; // else discs seen from the side leave gaps
  middle = seen;
  disc = vec4(n, 0.0);
  if (gl_PointSize > 1.5) {
    gl_PointSize = min(1.85 * gl_PointSize, 2.0 * sizes.y); // a circle in the square is smaller
    disc.w = 0.5 * gl_PointSize * away / focal;
  }
#endif
  return known ? 0.68 + 0.32 * abs(facing) : 1.0;
}`;

export const POINT_VERTEX = `${LAID_POINT}
uniform mat4 modelMatrix, modelViewMatrix;
uniform vec4 thinned[16]; // how much farther apart neighbors are than if all points were drawn
uniform int mode;        // 0 height, 1 value, 2 class, 3 plain
uniform bool known;      // whether the values of these points have been read
uniform vec2 ends;       // of the colors: in meters, or as fractions of the stored range
uniform vec3 colors[87]; // a ramp of 17, 68 classes, plain, unknown
in vec3 place;
in vec4 about;
in float value;
in float slot;           // of a point of a cube: which of its tiles has it, else 0
in float apart;          // distance of neighbors if all points were drawn, in octaves above 1 mm
flat out vec3 color;

void main() {
  vec3 p = (modelMatrix * vec4(place, 1.0)).xyz;
  vec3 seen = (modelViewMatrix * vec4(place, 1.0)).xyz;
  int own = int(slot + 0.5);
  float farther = thinned[own >> 2][own & 3];
  float apart_m = farther * 0.001 * exp2(12.0 * apart);
  float shade = lay(p, seen, about.xyz, 1.3 * apart_m);
  float at = ((mode == 0 ? p.z : value) - ends.x) / (ends.y - ends.x);
  at = 16.0 * clamp(at, 0.0, 1.0);
  if (mode == 1 && (!known || value > 0.99999)) at = 86.0;
  if (mode == 2) at = 17.0 + floor(clamp(about.w * 127.0 + 0.5, 0.0, 67.0));
  if (mode == 3) at = 85.0;
  int k = int(at);
  color = shade * mix(colors[k], colors[min(k + 1, 86)], at - float(k));
}`;

// Large points are discs in their surface: their depths are those of the disc, so surfaces have no
// steps where discs overlap, and of two in a surface the one with the nearer middle is seen.
// Without a graphics card a frame takes 1.3 to 2.3 times as long as one of squares.
export const POINT_FRAGMENT = `
precision highp float;
flat in vec3 color;
out vec4 pixel;
#ifdef DISCS
uniform mat4 projectionMatrix;
uniform bool parallel;
flat in vec3 middle;
flat in vec4 disc;

void main() {
  pixel = vec4(color, 1.0);
  gl_FragDepth = gl_FragCoord.z;
  if (disc.w == 0.0) return;
  vec3 beside = disc.w * vec3(2.0 * gl_PointCoord.x - 1.0, 1.0 - 2.0 * gl_PointCoord.y, 0.0);
  vec3 ahead = parallel ? vec3(0.0, 0.0, -1.0) : middle + beside;
  vec3 from = beside - dot(disc.xyz, beside) / dot(disc.xyz, ahead) * ahead;
  float part = dot(from, from) / (disc.w * disc.w);
  if (part > 1.0) discard;
  float z = middle.z + from.z - 0.3 * part * disc.w;
  vec2 depth = mat2(projectionMatrix[2].zw, projectionMatrix[3].zw) * vec2(z, 1.0);
  gl_FragDepth = 0.5 * depth.x / depth.y + 0.5;
}
#else
void main() { pixel = vec4(color, 1.0); }
#endif`;

export const SCREEN_VERTEX = `
in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`;

export const DEPTH_FRAGMENT = `
precision highp float; // FINE: eight neighbors, and gaps in surfaces are closed
uniform highp sampler2D colors, depths;
uniform vec2 nearness;   // offset and factor of a depth: 1 / m in perspective, else - m
uniform float scale;     // parallel: octaves of a meter; 0 = perspective
uniform float strength;  // 0 = no shading
uniform vec3 ground;
out vec4 shown;

float near = -1e9, sum = 0.0, nearer = 0.0, here;
ivec2 from;

// How much nearer a neighbor is, as a ratio of distances: equal ratios look equal.
void look(ivec2 at) {
  float d = texelFetch(depths, at, 0).r;
  if (d >= 1.0) return;
  float there = nearness.x + nearness.y * d;
  float step = scale > 0.0 ? scale * (there - here) : there / here - 1.0;
  sum += clamp(step, 0.0, 1.0);
  if (step > 0.05) nearer += 1.0;
  if (there > near) { near = there; from = at; }
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(depths, 0) - 1;
  float d = texelFetch(depths, at, 0).r;
#ifndef FINE
  if (d >= 1.0) { shown = vec4(ground, 1.0); return; }
#endif
  here = d < 1.0 ? nearness.x + nearness.y * d : scale > 0.0 ? -1e6 : 1e-6;
  look(ivec2(max(at.x - 1, 0), at.y));
  look(ivec2(min(at.x + 1, last.x), at.y));
  look(ivec2(at.x, max(at.y - 1, 0)));
  look(ivec2(at.x, min(at.y + 1, last.y)));
  float taps = 4.0;
#ifdef FINE
  if (d >= 1.0 && nearer < 3.0) { shown = vec4(ground, 1.0); return; }
  look(ivec2(max(at.x - 1, 0), max(at.y - 1, 0)));
  look(ivec2(min(at.x + 1, last.x), max(at.y - 1, 0)));
  look(ivec2(max(at.x - 1, 0), min(at.y + 1, last.y)));
  look(ivec2(min(at.x + 1, last.x), min(at.y + 1, last.y)));
  taps = 8.0;
  // A gap in a surface: most of its neighbors are nearer.
  if (nearer >= 6.0) { shown = texelFetch(colors, from, 0); return; }
  if (d >= 1.0) { shown = vec4(ground, 1.0); return; }
#endif
  shown = vec4(texelFetch(colors, at, 0).rgb * exp(-strength * sum / taps), 1.0);
}`;
