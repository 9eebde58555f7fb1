// SPDX-License-Identifier: MIT OR Apache-2.0
// The page: files and options in, what the worker answers on the screen.

import { LEGENDS, faceColors } from "./colors.js";
import { ModelView } from "./model_view.js";
import { UvView } from "./uv_view.js";

const element = (id) => document.getElementById(id);
const chosen = (name) => document.querySelector(`input[name="${name}"]:checked`).value;

// The file that is open, the mesh and the UVs that are shown.
const state = { text: null, name: "", mesh: null, uv: null, worker: null, isReady: false, file: null };

let modelView;
let uvView;

function main() {
  try {
    modelView = new ModelView(element("model"));
    uvView = new UvView(element("layout"));
  } catch (error) {
    tell(error.message, true);
    return;
  }
  startWorker();
  listen();
}

// 1. The worker

function startWorker() {
  stopWorker();
  state.worker = new Worker("worker.js", { type: "module" });
  state.worker.onmessage = ({ data }) => answers[data.kind](data);
  state.worker.onerror = ({ message }) => {
    const reason = message ?? "its script could not be loaded";
    answers.problem({ message: `The worker stopped: ${reason}`, isFatal: true });
  };
}

function stopWorker() {
  state.worker?.terminate();
  state.worker = null;
  state.isReady = false;
}

const answers = {
  ready() {
    state.isReady = true;
    document.body.dataset.ready = "yes";
    if (state.text === null) {
      tell("Drop a file, or choose a shape.");
    }
  },

  mesh(mesh) {
    state.mesh = mesh;
    modelView.setMesh(mesh);
    uvView.clear();
    showBefore(mesh.given);
    const size = `${counted(mesh.vertices.length / 3, "vertex")}, ${counted(mesh.triangles.length / 3, "triangle")}`;
    element("about").textContent = [`${state.name}: ${size}`, ...mesh.repairs.split("\n").filter(Boolean)].join(" · ");
    const seams = document.querySelector('input[name="seams"][value="file"]');
    seams.disabled = mesh.given === null;
  },

  progress({ fraction, message }) {
    element("progress").value = fraction;
    tell(`${message} …`);
  },

  uv(uv) {
    state.uv = uv;
    working(false);
    modelView.setUv(uv);
    modelView.setSeams(state.mesh.vertices, uv.seams);
    uvView.setUv(uv);
    shade();
    showFigures(uv.figures);
    offerDownload(uv.file);
    tell("Done.");
    document.body.dataset.state = "done";
  },

  problem({ message, isMendable, isFatal }) {
    working(false);
    if (isFatal && state.isReady) {
      startWorker();
    } else if (isFatal) {
      // one that could not start would fail again; the next run tries once more
      stopWorker();
    }
    tell(message, true);
    element("mend").hidden = !isMendable || element("repair").checked;
    document.body.dataset.state = "failed";
  },
};

function unwrap() {
  if (state.text === null) {
    return;
  }
  if (state.worker === null || document.body.dataset.state === "working") {
    startWorker();
  }
  forget();
  working(true);
  const seams = chosen("seams");
  const keepSeams = seams === "file";
  const target = keepSeams ? 1.4 : Number(seams);
  const repair = element("repair").checked;
  state.worker.postMessage({ text: state.text, repair, keepSeams, target, preset: chosen("preset") });
}

// 2. Files

function open(name, text) {
  state.name = name;
  state.text = text;
  state.mesh = null;
  const seams = document.querySelector('input[name="seams"][value="file"]');
  if (seams.checked) {
    document.querySelector('input[name="seams"][value="1.4"]').checked = true;
  }
  element("about").textContent = "";
  showBefore(null);
  for (const view of [modelView, uvView]) {
    view.reset();
    view.clear();
  }
  unwrap();
}

async function openFile(file) {
  if (!/\.obj$/i.test(file.name)) {
    if (document.body.dataset.state === "working") {
      startWorker();
      working(false);
    }
    tell(`${file.name} is no OBJ file. Export the mesh as Wavefront OBJ.`, true);
    document.body.dataset.state = "failed";
    return;
  }
  open(file.name, await file.text());
}

async function openShape(name) {
  const answer = await fetch(`shapes/${name}.obj`);
  if (answer.ok) {
    open(`${name}.obj`, await answer.text());
  } else {
    tell(`The shape could not be loaded (${answer.status}).`, true);
  }
}

// 3. What is shown

function tell(message, isAlarm = false) {
  element("message").textContent = message;
  element("message").classList.toggle("alarm", isAlarm);
}

function working(isWorking) {
  document.body.dataset.state = isWorking ? "working" : "";
  element("progress").hidden = !isWorking;
  element("progress").removeAttribute("value");
  element("stop").hidden = !isWorking;
  if (isWorking) {
    tell("Reading …");
  }
}

// Hides what belonged to the last UVs.
function forget() {
  state.uv = null;
  for (const id of ["figures", "download-row", "mend", "legend"]) {
    element(id).hidden = true;
  }
}

function shade() {
  if (state.uv === null) {
    return;
  }
  const shading = chosen("shading");
  const colors = faceColors(shading, state.uv);
  modelView.setShading(colors, shading === "checker");
  uvView.setColors(colors);
  const legend = LEGENDS[shading];
  element("legend").hidden = legend === undefined;
  if (legend) {
    [element("legend-low").textContent, element("legend-high").textContent] = legend;
    element("legend-ramp").className = shading;
  }
}

function showBefore(given) {
  for (const cell of document.querySelectorAll("#before-head, [id^=before-], .before")) {
    cell.hidden = given === null;
  }
  if (given !== null) {
    showCommon(given, "before-");
  }
}

function showFigures(figures) {
  showCommon(figures, "");
  element("seam-length").textContent = figures.seamLength.toFixed(2);
  element("packed").textContent = `${(100 * figures.packed).toFixed(0)} %`;
  element("seconds").textContent = `${figures.seconds.toFixed(figures.seconds < 10 ? 2 : 0)} s`;
  element("figures").hidden = false;
  // exact, for programs
  element("figures").dataset.figures = JSON.stringify(figures);
}

function showCommon({ areaError, shear, flipped, islands }, prefix) {
  const percent = 100 * areaError;
  element(`${prefix}area`).textContent = `${percent < 9.95 ? percent.toPrecision(2) : percent.toFixed(0)} %`;
  element(`${prefix}shear`).textContent = Number.isFinite(shear) ? shear.toFixed(3) : "–";
  element(`${prefix}flipped`).textContent = String(flipped);
  element(`${prefix}flipped`).classList.toggle("worse", flipped > 0);
  element(`${prefix}islands`).textContent = String(islands);
}

function offerDownload(text) {
  if (state.file) {
    URL.revokeObjectURL(state.file);
  }
  state.file = URL.createObjectURL(new Blob([text], { type: "model/obj" }));
  element("download").href = state.file;
  element("download").download = state.name.replace(/(\.obj)?$/i, "-uv.obj");
  element("download-row").hidden = false;
}

function counted(count, noun) {
  const plural = noun === "vertex" ? "vertices" : `${noun}s`;
  return `${count.toLocaleString("en")} ${count === 1 ? noun : plural}`;
}

// 4. What a person does

function listen() {
  element("file").addEventListener("change", ({ target }) => {
    if (target.files.length > 0) {
      openFile(target.files[0]);
      target.value = "";
    }
  });
  for (const button of document.querySelectorAll("[data-shape]")) {
    button.addEventListener("click", () => openShape(button.dataset.shape));
  }
  element("options").addEventListener("change", unwrap);
  element("shading").addEventListener("change", shade);
  element("show-seams").addEventListener("change", ({ target }) => {
    modelView.hasSeams = target.checked;
    modelView.ask();
  });
  element("stop").addEventListener("click", () => {
    startWorker();
    working(false);
    tell("Stopped.");
  });
  element("mend").addEventListener("click", () => {
    element("repair").checked = true;
    unwrap();
  });
  listenToDrops();
}

function listenToDrops() {
  let depth = 0;
  const show = (change) => {
    depth = Math.max(0, depth + change);
    element("veil").hidden = depth === 0;
  };
  addEventListener("dragenter", () => show(1));
  addEventListener("dragleave", () => show(-1));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    show(-depth);
    const [file] = event.dataTransfer.files;
    if (file) {
      openFile(file);
    }
  });
}

main();
