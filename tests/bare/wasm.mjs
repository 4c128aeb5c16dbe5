// Runs the program's WebAssembly: node wasm.mjs FILE
import { readFileSync, writeSync } from "node:fs";

let memory;
const host = {
  write: (at, bytes) => writeSync(1, new Uint8Array(memory.buffer, at, bytes)),
  exit: (code) => process.exit(code),
};
const { instance } = await WebAssembly.instantiate(readFileSync(process.argv[2]), { host });
memory = instance.exports.memory;
instance.exports.run();
process.exit(1); // the program ends by calling exit
