// SPDX-License-Identifier: MIT OR Apache-2.0
// The worker: runs the core, so that the page never freezes. It is told `{text, repair, keepSeams, target, preset}` and
// answers with messages of a `kind`: "ready", "mesh", "progress", "uv", "problem".

import init, { PageMesh, Problem } from "./authalic_web.js";
import { wordsOfFailure } from "./failures.js";

let panic = "";
let lastReport = 0;

self.reportPanic = (message) => {
  panic = message;
};

self.reportProgress = (fraction, message) => {
  const now = performance.now();
  if (now - lastReport > 60) {
    lastReport = now;
    self.postMessage({ kind: "progress", fraction, message });
  }
};

const isReady = init({ module_or_path: new URL("authalic_web_bg.wasm", import.meta.url) }).then(
  () => self.postMessage({ kind: "ready" }),
  (error) => self.postMessage({ kind: "problem", message: `WebAssembly could not be started: ${error}`, isFatal: true }),
);

self.onmessage = async ({ data }) => {
  await isReady;
  try {
    unwrap(data);
  } catch (error) {
    self.postMessage({ kind: "problem", ...wordsOf(error) });
  }
};

function unwrap({ text, repair, keepSeams, target, preset }) {
  // 1. The mesh, which can be shown before it has UVs
  const mesh = new PageMesh(text, repair);
  const given = figuresOf(mesh.given());
  const shape = { vertices: mesh.vertices(), triangles: mesh.triangles() };
  self.postMessage({ kind: "mesh", ...shape, given, repairs: mesh.repairs() });
  // 2. Its UVs; the core has no clock here
  const began = performance.now();
  const uv = mesh.unwrap(keepSeams && given !== null, target, preset);
  const seconds = (performance.now() - began) / 1000;
  // 3. Arrays for drawing
  const arrays = {
    points: uv.points(),
    corners: uv.corners(),
    islands: uv.islands(),
    seams: uv.seams(),
    areaRatios: uv.areaRatios(),
    shears: uv.shears(),
  };
  const figures = { ...figuresOf(uv.figures()), seamLength: uv.seamLength(), packed: uv.packed(), seconds };
  const buffers = Object.values(arrays).map((array) => array.buffer);
  self.postMessage({ kind: "uv", ...arrays, figures, file: uv.file() }, buffers);
  uv.free();
  mesh.free();
}

function figuresOf(figures) {
  if (!figures) {
    return null;
  }
  const { areaError, shear, flipped, islands } = figures;
  return { areaError, shear, flipped, islands };
}

function wordsOf(error) {
  if (error instanceof Problem) {
    return { message: error.message, errorKind: error.kind, isMendable: error.isMendable, isFatal: false };
  }
  return wordsOfFailure(panic, error);
}
