export * from "./answers.js";
export * from "./broad_phase.js";
export * from "./detector.js";
export * from "./detector_types.js";
export { hasSimd, Orchard, type LoadOptions } from "./orchard.js";
export * from "./pair.js";
export * from "./pose.js";
export * from "./tree.js";
