// A worker that makes an orchard of its own of a compiled module.
import { parentPort, workerData } from "node:worker_threads";
import { identity, loadOrchard, Tree } from "orchard-runtime";

const orchard = await loadOrchard(workerData);
const box = Tree.box(orchard, [1, 1, 1]);
parentPort.postMessage({ version: orchard.version, inside: box.contains(identity(), [0.5, 0, 0]) });
