// SPDX-License-Identifier: MIT OR Apache-2.0
// What both views share: programs, buffers, the size of a canvas, and pointers.

export function context(canvas) {
  const gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
  if (!gl) {
    throw new Error("This browser has no WebGL 2, by which the page draws.");
  }
  return gl;
}

export function program(gl, vertexSource, fragmentSource) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertexSource], [gl.FRAGMENT_SHADER, fragmentSource]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, `#version 300 es\nprecision highp float;\n${source}`);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) {
      throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) {
    throw new Error(gl.getProgramInfoLog(made));
  }
  return made;
}

// Attributes `{name: [array, size]}` of a program in a vertex array. With `perInstance` each is one per instance.
export function vertexArray(gl, of, attributes, perInstance = []) {
  const made = gl.createVertexArray();
  gl.bindVertexArray(made);
  const buffers = Object.entries(attributes).map(([name, [array, size]]) => {
    const buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
    const place = gl.getAttribLocation(of, name);
    if (place >= 0) {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
      gl.vertexAttribDivisor(place, perInstance.includes(name) ? 1 : 0);
    }
    return buffer;
  });
  gl.bindVertexArray(null);
  const free = () => {
    buffers.forEach((buffer) => gl.deleteBuffer(buffer));
    gl.deleteVertexArray(made);
  };
  return { made, free };
}

export function uniforms(gl, of, values) {
  for (const [name, value] of Object.entries(values)) {
    const place = gl.getUniformLocation(of, name);
    if (typeof value === "number") {
      gl.uniform1f(place, value);
    } else if (value.length === 16) {
      gl.uniformMatrix4fv(place, false, value);
    } else {
      gl[`uniform${value.length}f`](place, ...value);
    }
  }
}

// Calls `draw` once before the next frame, however often it is asked, and whenever the canvas changes its size.
export function redrawer(canvas, draw) {
  let isAsked = false;
  const ask = () => {
    if (!isAsked) {
      isAsked = true;
      requestAnimationFrame(() => {
        isAsked = false;
        draw();
      });
    }
  };
  new ResizeObserver(() => {
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * devicePixelRatio));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * devicePixelRatio));
    ask();
  }).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", ask);
  return ask;
}

// The color of a property of the page's style sheet, each channel in [0, 1].
export function styleColor(name) {
  const probe = document.createElement("i");
  probe.style.color = `var(${name})`;
  document.body.append(probe);
  const channels = getComputedStyle(probe).color.match(/[\d.]+/g).slice(0, 3).map((channel) => channel / 255);
  probe.remove();
  return channels;
}

// Tells of drags: `move(dx, dy, isSecondary)` in pixels, `zoom(factor, x, y)` around a place, `reset()`.
export function followPointers(canvas, { move, zoom, reset }) {
  const pointers = new Map();
  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) {
      return;
    }
    const now = [event.offsetX, event.offsetY];
    const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (others.length > 0) {
      const far = (place) => Math.hypot(place[0] - others[0][0], place[1] - others[0][1]) + 1;
      zoom(far(now) / far(before), (now[0] + others[0][0]) / 2, (now[1] + others[0][1]) / 2);
      move(dx / 2, dy / 2, true);
    } else {
      move(dx, dy, event.shiftKey || (event.buttons & 6) !== 0);
    }
    pointers.set(event.pointerId, now);
  });
  for (const kind of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(kind, (event) => pointers.delete(event.pointerId));
  }
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("dblclick", reset);
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), event.offsetX, event.offsetY);
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    const steps = { ArrowLeft: [-20, 0], ArrowRight: [20, 0], ArrowUp: [0, -20], ArrowDown: [0, 20] };
    const center = [canvas.clientWidth / 2, canvas.clientHeight / 2];
    if (event.key in steps) {
      event.preventDefault();
      move(...steps[event.key], event.shiftKey);
    } else if (event.key === "+" || event.key === "-") {
      zoom(event.key === "+" ? 1.15 : 1 / 1.15, ...center);
    } else if (event.key === "Home") {
      reset();
    }
  });
}
