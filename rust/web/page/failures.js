// SPDX-License-Identifier: MIT OR Apache-2.0
// What the page says where the core itself has failed; the module is of no more use then.

// Not any "memory": a fault may be an access out of bounds, or come from a file of that name.
const NO_MEMORY =
  /memory allocation of|unable to grow|allocation failed|capacity overflow|out of memory|invalid (typed )?array (buffer )?length/i;

// The words on an exception, and on the panic before it, if any. Without memory the core stops without a panic.
export function wordsOfFailure(panic, error) {
  const isTrap = error instanceof WebAssembly.RuntimeError && /unreachable/i.test(error.message);
  if (NO_MEMORY.test(panic || String(error)) || (isTrap && !panic)) {
    const message =
      "The mesh is too large for the memory of this page. Reduce it, or use the extension or the Python package.";
    return { message, errorKind: "out_of_memory", isMendable: false, isFatal: true };
  }
  const message = `The core stopped (${panic || error}). Please report this mesh.`;
  return { message, errorKind: "panic", isMendable: false, isFatal: true };
}
