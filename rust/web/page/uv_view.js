// SPDX-License-Identifier: MIT OR Apache-2.0
// The UV layout: the unit square with its islands, their edges and their outlines.

import { context, followPointers, program, redrawer, styleColor, uniforms, vertexArray } from "./gl.js";

const BORDER = 0.06;

const VERTEX = `
in vec2 point;
in vec3 color;
uniform vec2 scale, offset;
out vec3 vColor;
void main() {
  vColor = color;
  gl_Position = vec4(point * scale + offset, 0.0, 1.0);
}`;

const FRAGMENT = `
in vec3 vColor;
uniform vec3 tint;
uniform float isTinted, alpha;
out vec4 result;
void main() { result = vec4(mix(vColor, tint, isTinted), alpha); }`;

export class UvView {
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = context(canvas);
    this.program = program(this.gl, VERTEX, FRAGMENT);
    this.reset();
    this.square = this.lines([0, 0, 1, 0, 1, 0, 1, 1, 1, 1, 0, 1, 0, 1, 0, 0]);
    this.ask = redrawer(canvas, () => this.draw());
    followPointers(canvas, {
      move: (dx, dy) => this.move(dx, dy),
      zoom: (factor, x, y) => this.zoom(factor, x, y),
      reset: () => {
        this.reset();
        this.ask();
      },
    });
  }

  reset() {
    this.view = { scale: 1, center: [0.5, 0.5] };
  }

  clear() {
    for (const part of ["faces", "edges", "outlines"]) {
      this[part]?.free();
      this[part] = undefined;
    }
    this.ask();
  }

  // Points (k, 2) of faces (m, 3).
  setUv({ points, corners }) {
    this.clear();
    this.points = points;
    this.corners = corners;
    const { inner, outer } = edges(corners);
    this.edges = this.lines(at(points, inner));
    this.outlines = this.lines(at(points, outer));
  }

  // Colors (m, 3) of the faces.
  setColors(colors) {
    const { points, corners } = this;
    const ofCorners = new Float32Array(3 * corners.length);
    for (let corner = 0; corner < corners.length; corner += 1) {
      const face = Math.floor(corner / 3);
      ofCorners.set(colors.subarray(3 * face, 3 * face + 3), 3 * corner);
    }
    this.faces?.free();
    const attributes = { point: [at(points, corners), 2], color: [ofCorners, 3] };
    this.faces = { ...vertexArray(this.gl, this.program, attributes), count: corners.length };
    this.ask();
  }

  lines(points) {
    const array = new Float32Array(points);
    const attributes = { point: [array, 2], color: [new Float32Array((3 * array.length) / 2), 3] };
    return { ...vertexArray(this.gl, this.program, attributes), count: array.length / 2 };
  }

  // Pixels per unit of the square.
  get unit() {
    const { clientWidth, clientHeight } = this.canvas;
    return Math.min(clientWidth, clientHeight) * (1 - 2 * BORDER) * this.view.scale;
  }

  move(dx, dy) {
    const { center } = this.view;
    this.view.center = [center[0] - dx / this.unit, center[1] + dy / this.unit];
    this.ask();
  }

  zoom(factor, x, y) {
    const { clientWidth, clientHeight } = this.canvas;
    const away = [x - clientWidth / 2, clientHeight / 2 - y];
    const before = this.unit;
    this.view.scale = Math.min(Math.max(this.view.scale * factor, 0.3), 60);
    this.view.center = this.view.center.map((c, k) => c + away[k] / before - away[k] / this.unit);
    this.ask();
  }

  draw() {
    const { gl, canvas } = this;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...styleColor("--pane"), 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.useProgram(this.program);
    const scale = [(2 * this.unit) / canvas.clientWidth, (2 * this.unit) / canvas.clientHeight];
    const offset = this.view.center.map((c, k) => -c * scale[k]);
    uniforms(gl, this.program, { scale, offset });
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    const fine = Math.min(0.4, (0.4 * this.unit) / 600 / Math.sqrt((this.corners?.length ?? 0) / 30000 + 0.2));
    this.drawPart(this.square, gl.LINES, styleColor("--line"), 1, 1);
    this.drawPart(this.faces, gl.TRIANGLES, [0, 0, 0], 0, 1);
    this.drawPart(this.edges, gl.LINES, [0, 0, 0], 1, fine);
    this.drawPart(this.outlines, gl.LINES, [0.86, 0.16, 0.24], 1, 1);
    gl.bindVertexArray(null);
  }

  drawPart(part, kind, tint, isTinted, alpha) {
    if (part && part.count > 0) {
      const { gl } = this;
      uniforms(gl, this.program, { tint, isTinted, alpha });
      gl.bindVertexArray(part.made);
      gl.drawArrays(kind, 0, part.count);
    }
  }
}

// The rows of points (k, 2) at indices.
function at(points, indices) {
  const result = new Float32Array(2 * indices.length);
  indices.forEach((index, k) => {
    result[2 * k] = points[2 * index];
    result[2 * k + 1] = points[2 * index + 1];
  });
  return result;
}

// The edges of two faces and those of one, each as pairs of points.
function edges(corners) {
  const count = new Map();
  const keys = [];
  for (let corner = 0; corner < corners.length; corner += 1) {
    const next = corner % 3 === 2 ? corner - 2 : corner + 1;
    const [low, high] = [corners[corner], corners[next]].sort((a, b) => a - b);
    const key = low * 2 ** 26 + high;
    keys.push(key);
    count.set(key, (count.get(key) ?? 0) + 1);
  }
  const [inner, outer] = [[], []];
  for (const [key, times] of count) {
    (times > 1 ? inner : outer).push(Math.floor(key / 2 ** 26), key % 2 ** 26);
  }
  return { inner, outer };
}
