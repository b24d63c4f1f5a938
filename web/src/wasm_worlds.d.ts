/** Both builds of the module in base64: build.mjs writes them. */
export const SIMD: string;
export const PLAIN: string;
