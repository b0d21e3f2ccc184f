// Shaders of the map: points, and the pass that shades edges by depth.

export const POINT_VERTEX = `
precision highp float;
uniform mat4 modelMatrix, modelViewMatrix, projectionMatrix;
uniform mat3 turn;       // from the map to the eye
uniform vec4 thinned[16]; // how much farther apart neighbors are than if all points were drawn
uniform float focal;     // pixels of a meter at a meter's distance; parallel: at any distance
uniform bool parallel;
uniform vec2 sizes;      // smallest and largest point [px]
uniform int mode;        // 0 height, 1 value, 2 class, 3 plain
uniform bool known;      // whether the values of these points have been read
uniform vec2 ends;       // of the colors: in meters, or as fractions of the stored range
uniform vec3 ramp[17];
uniform vec3 classes[68];
uniform vec3 unknown;
uniform vec3 plain;
uniform vec4 planes[12];
uniform int planeCount;
in vec3 place;
in vec4 about;
in float value;
in float slot;           // of a point of a cube: which of its tiles has it, else 0
in float apart;          // distance of neighbors if all points were drawn, in octaves above 1 mm
flat out vec3 color;
#ifdef DISCS
flat out vec3 middle;    // of the point, from the eye [m]
flat out vec4 disc;      // its normal, and its radius [m]; 0 = a square of a few pixels
#endif

vec3 colorAt(float t) {
  float at = clamp(t, 0.0, 1.0) * 16.0;
  int k = min(int(at), 15);
  return mix(ramp[k], ramp[k + 1], at - float(k));
}

void main() {
  vec4 p = modelMatrix * vec4(place, 1.0);
  vec4 seen = modelViewMatrix * vec4(place, 1.0);
  gl_Position = projectionMatrix * seen;
  for (int k = 0; k < planeCount; k++)
    if (dot(planes[k].xyz, p.xyz) + planes[k].w < 0.0) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
      gl_PointSize = 1.0;
      return;
    }
  float away = parallel ? 1.0 : max(-seen.z, 0.01);
  int own = int(slot + 0.5);
  float farther = thinned[own >> 2][own & 3];
  float apart_m = farther * 0.001 * exp2(12.0 * apart);
  gl_PointSize = clamp(1.3 * apart_m * focal / away, sizes.x, sizes.y);
  if (mode == 0) color = colorAt((p.z - ends.x) / (ends.y - ends.x));
  else if (mode == 1 && (!known || value > 0.99999)) color = unknown;
  else if (mode == 1) color = colorAt((value - ends.x) / (ends.y - ends.x));
  else if (mode == 2) color = classes[clamp(int(about.w * 127.0 + 0.5), 0, 67)];
  else color = plain;
  float normal = dot(about.xyz, about.xyz);
  vec3 toEye = parallel ? vec3(0.0, 0.0, 1.0) : normalize(-seen.xyz);
  vec3 n = toEye;
  if (normal > 0.2) {
    n = turn * about.xyz / sqrt(normal);
    float facing = dot(n, toEye);
    color *= 0.68 + 0.32 * abs(facing);
    n = facing < 0.0 ? -n : n;
    n += max(0.35 - abs(facing), 0.0) * toEye; // else discs seen from the side leave gaps
  }
#ifdef DISCS
  middle = seen.xyz;
  disc = vec4(n, 0.0);
  if (gl_PointSize > 1.5) {
    gl_PointSize = min(1.85 * gl_PointSize, 2.0 * sizes.y); // a circle in the square is smaller
    disc.w = 0.5 * gl_PointSize * away / focal;
  }
#endif
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
precision highp float;
uniform highp sampler2D colors, depths;
uniform vec2 nearness;   // offset and factor of a depth: 1 / m in perspective, else - m
uniform float scale;     // parallel: octaves of a meter; 0 = perspective
uniform float strength;  // 0 = no shading
uniform bool fine;       // eight neighbors, and gaps in surfaces are closed
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
  if (d >= 1.0 && !fine) { shown = vec4(ground, 1.0); return; }
  here = d < 1.0 ? nearness.x + nearness.y * d : scale > 0.0 ? -1e6 : 1e-6;
  look(ivec2(max(at.x - 1, 0), at.y));
  look(ivec2(min(at.x + 1, last.x), at.y));
  look(ivec2(at.x, max(at.y - 1, 0)));
  look(ivec2(at.x, min(at.y + 1, last.y)));
  if (d >= 1.0 && nearer < 3.0) { shown = vec4(ground, 1.0); return; }
  float taps = 4.0;
  if (fine) {
    look(ivec2(max(at.x - 1, 0), max(at.y - 1, 0)));
    look(ivec2(min(at.x + 1, last.x), max(at.y - 1, 0)));
    look(ivec2(max(at.x - 1, 0), min(at.y + 1, last.y)));
    look(ivec2(min(at.x + 1, last.x), min(at.y + 1, last.y)));
    taps = 8.0;
    // A gap in a surface: most of its neighbors are nearer.
    if (nearer >= 6.0) { shown = texelFetch(colors, from, 0); return; }
    if (d >= 1.0) { shown = vec4(ground, 1.0); return; }
  }
  shown = vec4(texelFetch(colors, at, 0).rgb * exp(-strength * sum / taps), 1.0);
}`;
