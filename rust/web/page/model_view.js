// SPDX-License-Identifier: MIT OR Apache-2.0
// The model in space: lit, with a checker texture or the colors of its faces, and its seams.

import { CLAY } from "./colors.js";
import { context, followPointers, program, redrawer, styleColor, uniforms, vertexArray } from "./gl.js";

// The cosine of the angle up to which neighboring faces are shaded as one.
const SMOOTH = Math.cos((40 * Math.PI) / 180);
// Squares of the checker along a side of the texture.
const SQUARES = 48;
const FIELD = (32 * Math.PI) / 180;
const HOME = { yaw: -0.65, pitch: 0.3, distance: 1, pan: [0, 0] };

const SURFACE_VERTEX = `
in vec3 place, normal, color;
in vec2 uv;
uniform mat4 toScreen, toEye;
out vec3 vNormal, vEye, vColor;
out vec2 vUv;
void main() {
  vNormal = mat3(toEye) * normal;
  vEye = (toEye * vec4(place, 1.0)).xyz;
  vColor = color;
  vUv = uv;
  gl_Position = toScreen * vec4(place, 1.0);
}`;

// The checker's edges are as wide as a pixel; squares smaller than that become gray.
const SURFACE_FRAGMENT = `
in vec3 vNormal, vEye, vColor;
in vec2 vUv;
uniform float isChecker, squares;
out vec4 result;

float stripes(float x) {
  float width = max(fwidth(x), 1e-6);
  float edge = abs(fract(x / 2.0) * 2.0 - 1.0) - 0.5;
  return mix(clamp(edge / width + 0.5, 0.0, 1.0), 0.5, clamp(width - 0.4, 0.0, 1.0));
}

void main() {
  vec3 base = vColor;
  if (isChecker > 0.5) {
    vec2 p = vUv * squares;
    float u = stripes(p.x), v = stripes(p.y);
    float isLight = u * v + (1.0 - u) * (1.0 - v);
    vec2 block = floor(p / 6.0);
    vec3 tint = mod(block.x + block.y, 2.0) < 0.5 ? vec3(0.18, 0.42, 0.44) : vec3(0.36, 0.30, 0.42);
    base = mix(tint, vec3(0.95, 0.93, 0.87), isLight);
  }
  vec3 normal = normalize(vNormal);
  vec3 eye = normalize(-vEye);
  if (dot(normal, eye) < 0.0) normal = -normal;
  float key = max(dot(normal, normalize(vec3(-0.5, 0.8, 0.75))), 0.0);
  float fill = max(dot(normal, normalize(vec3(0.9, 0.1, 0.5))), 0.0);
  float rim = pow(1.0 - max(dot(normal, eye), 0.0), 3.0);
  vec3 lit = base * (0.42 + 0.55 * key + 0.17 * fill) + 0.06 * rim;
  result = vec4(lit, 1.0);
}`;

// A line is a rectangle of constant width on the screen, a little nearer than the surface.
const LINE_VERTEX = `
in vec3 from, to;
in vec2 corner;
uniform mat4 toScreen;
uniform vec2 size;
uniform float width;
void main() {
  vec4 a = toScreen * vec4(from, 1.0), b = toScreen * vec4(to, 1.0);
  vec2 along = (b.xy / b.w - a.xy / a.w) * size;
  along = length(along) < 1e-6 ? vec2(1.0, 0.0) : normalize(along);
  vec4 end = corner.x < 0.5 ? a : b;
  vec2 shift = (along * (corner.x * 2.0 - 1.0) * 0.5 + vec2(-along.y, along.x) * corner.y) * width;
  end.xy += shift / size * end.w;
  end.z -= 0.0012 * end.w;
  gl_Position = end;
}`;

const LINE_FRAGMENT = `
uniform vec3 color;
uniform float alpha;
out vec4 result;
void main() { result = vec4(color, alpha); }`;

export class ModelView {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = context(canvas);
    this.surface = program(this.gl, SURFACE_VERTEX, SURFACE_FRAGMENT);
    this.line = program(this.gl, LINE_VERTEX, LINE_FRAGMENT);
    this.isChecker = false;
    this.hasSeams = true;
    this.reset();
    this.ask = redrawer(canvas, () => this.draw());
    followPointers(canvas, {
      move: (dx, dy, isSecondary) => this.move(dx, dy, isSecondary),
      zoom: (factor) => this.zoom(factor),
      reset: () => {
        this.reset();
        this.ask();
      },
    });
  }

  reset() {
    this.camera = structuredClone(HOME);
  }

  clear() {
    this.array?.free();
    this.array = undefined;
    this.ask();
  }

  // Shows vertices (n, 3) and triangles (m, 3) that have no UVs yet.
  setMesh({ vertices, triangles }) {
    this.frame = frameOf(vertices);
    this.places = expanded(normalized(vertices, this.frame), triangles, 3);
    this.normals = cornerNormals(this.places, triangles);
    this.uv = new Float32Array((2 * this.places.length) / 3);
    this.colors = spread(CLAY, triangles.length);
    this.isChecker = false;
    this.setSeams(vertices, new Uint32Array());
    this.upload();
  }

  // The UVs of the corners: points (k, 2) by their numbers (m, 3).
  setUv({ points, corners }) {
    this.uv = expanded(points, corners, 2);
  }

  // Colors (m, 3) of faces, or the checker.
  setShading(colors, isChecker) {
    this.isChecker = isChecker;
    this.colors = new Float32Array(3 * colors.length);
    for (let corner = 0; corner < colors.length; corner += 1) {
      const face = Math.floor(corner / 3);
      this.colors.set(colors.subarray(3 * face, 3 * face + 3), 3 * corner);
    }
    this.upload();
  }

  // The ends (s, 2) of seams among vertices (n, 3).
  setSeams(vertices, seams) {
    const ends = expanded(normalized(vertices, this.frame), seams, 3);
    const count = seams.length / 2;
    const [from, to] = [new Float32Array(3 * count), new Float32Array(3 * count)];
    for (let seam = 0; seam < count; seam += 1) {
      from.set(ends.subarray(6 * seam, 6 * seam + 3), 3 * seam);
      to.set(ends.subarray(6 * seam + 3, 6 * seam + 6), 3 * seam);
    }
    this.seamArray?.free();
    const corner = new Float32Array([0, -0.5, 1, -0.5, 0, 0.5, 1, 0.5]);
    const attributes = { from: [from, 3], to: [to, 3], corner: [corner, 2] };
    this.seamArray = { ...vertexArray(this.gl, this.line, attributes, ["from", "to"]), count };
  }

  upload() {
    this.array?.free();
    const { places, normals, uv, colors } = this;
    const attributes = { place: [places, 3], normal: [normals, 3], uv: [uv, 2], color: [colors, 3] };
    this.array = vertexArray(this.gl, this.surface, attributes);
    this.ask();
  }

  move(dx, dy, isSecondary) {
    const { camera } = this;
    if (isSecondary) {
      const unit = (camera.distance * 1.3) / this.canvas.clientHeight;
      camera.pan = [camera.pan[0] + dx * unit, camera.pan[1] - dy * unit];
    } else {
      camera.yaw += dx * 0.009;
      camera.pitch = Math.min(Math.max(camera.pitch + dy * 0.009, -1.55), 1.55);
    }
    this.ask();
  }

  zoom(factor) {
    this.camera.distance = Math.min(Math.max(this.camera.distance / factor, 0.05), 6);
    this.ask();
  }

  draw() {
    const { gl, canvas, array } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...styleColor("--pane"), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!array) {
      return;
    }
    const { toEye, toScreen } = matrices(this.camera, canvas.width / canvas.height);
    gl.enable(gl.DEPTH_TEST);
    gl.useProgram(this.surface);
    uniforms(gl, this.surface, { toEye, toScreen, isChecker: this.isChecker ? 1 : 0, squares: SQUARES });
    gl.bindVertexArray(array.made);
    gl.drawArrays(gl.TRIANGLES, 0, this.places.length / 3);
    if (this.hasSeams && this.seamArray.count > 0) {
      this.drawSeams(toScreen);
    }
    gl.bindVertexArray(null);
  }

  drawSeams(toScreen) {
    const { gl, canvas, seamArray } = this;
    gl.useProgram(this.line);
    gl.bindVertexArray(seamArray.made);
    const size = [canvas.width / 2, canvas.height / 2];
    const color = [0.86, 0.16, 0.24];
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthMask(false);
    // faint behind the surface, then full in front of it
    for (const [test, alpha, width] of [[gl.GREATER, 0.13, 2], [gl.LEQUAL, 1, 3]]) {
      gl.depthFunc(test);
      uniforms(gl, this.line, { toScreen, size, color, alpha, width: width * devicePixelRatio });
      gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, seamArray.count);
    }
    gl.depthFunc(gl.LESS);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }
}

// The center of a box around points (n, 3), and half the length of its diagonal.
function frameOf(vertices) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let k = 0; k < vertices.length; k += 1) {
    low[k % 3] = Math.min(low[k % 3], vertices[k]);
    high[k % 3] = Math.max(high[k % 3], vertices[k]);
  }
  const center = low.map((value, k) => (value + high[k]) / 2);
  return { center, radius: Math.hypot(...high.map((value, k) => value - low[k])) / 2 || 1 };
}

function normalized(vertices, { center, radius }) {
  return vertices.map((value, k) => (value - center[k % 3]) / radius);
}

// The row of `values` of each index, one after the other.
function expanded(values, indices, width) {
  const result = new Float32Array(width * indices.length);
  for (let k = 0; k < indices.length; k += 1) {
    for (let j = 0; j < width; j += 1) {
      result[width * k + j] = values[width * indices[k] + j];
    }
  }
  return result;
}

function spread(color, count) {
  return new Float32Array(3 * count).map((_, k) => color[k % 3]);
}

// At each corner the mean of the normals of faces around its vertex that differ little from its own face's.
function cornerNormals(places, triangles) {
  const m = triangles.length / 3;
  const faceNormals = Array.from({ length: m }, (_, face) => normal(places, face));
  const unit = faceNormals.map((n) => n.map((x) => x / (Math.hypot(...n) || 1)));
  const around = Array.from({ length: largest(triangles) + 1 }, () => []);
  triangles.forEach((vertex, corner) => around[vertex].push(Math.floor(corner / 3)));
  const result = new Float32Array(9 * m);
  triangles.forEach((vertex, corner) => {
    const own = unit[Math.floor(corner / 3)];
    const sum = [0, 0, 0];
    for (const face of around[vertex]) {
      const isNear = own[0] * unit[face][0] + own[1] * unit[face][1] + own[2] * unit[face][2] > SMOOTH;
      for (let k = 0; k < 3 && isNear; k += 1) {
        sum[k] += faceNormals[face][k];
      }
    }
    const length = Math.hypot(...sum) || 1;
    result.set(sum.map((x) => x / length), 3 * corner);
  });
  return result;
}

// The largest index; spreading a long array would be too much for a call.
function largest(indices) {
  return indices.reduce((most, index) => Math.max(most, index), -1);
}

// Twice the area vector of a face.
function normal(places, face) {
  const at = (corner, k) => places[9 * face + 3 * corner + k];
  const [p, q] = [1, 2].map((corner) => [0, 1, 2].map((k) => at(corner, k) - at(0, k)));
  return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
}

function matrices({ yaw, pitch, distance, pan }, aspect) {
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  const far = (distance * 0.94) / Math.sin(FIELD / 2) / Math.min(aspect, 1);
  // columns of a rotation about the upright axis, then about the one to the right
  const toEye = [cy, sp * sy, -cp * sy, 0, 0, cp, sp, 0, sy, -sp * cy, cp * cy, 0, pan[0], pan[1], -far, 1];
  const f = 1 / Math.tan(FIELD / 2);
  const [near, end] = [Math.max(far - 1.5, 0.01), far + 1.5];
  const depth = [(end + near) / (near - end), (2 * end * near) / (near - end)];
  const toScreen = [];
  for (let column = 0; column < 4; column += 1) {
    const [x, y, z, w] = toEye.slice(4 * column, 4 * column + 4);
    toScreen.push((f / aspect) * x, f * y, depth[0] * z + depth[1] * w, -z);
  }
  return { toEye: new Float32Array(toEye), toScreen: new Float32Array(toScreen) };
}
