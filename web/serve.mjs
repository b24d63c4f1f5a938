// Serves folders on loopback: node serve.mjs PORT FOLDER [/PREFIX=FOLDER..]; port 0 takes a free one. Exports serve().
import { createReadStream } from "node:fs";
import { stat } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { pathToFileURL } from "node:url";

const TYPES = { ".html": "text/html; charset=utf-8", ".js": "text/javascript", ".mjs": "text/javascript", ".css": "text/css",
  ".wasm": "application/wasm", ".woff2": "font/woff2", ".txt": "text/plain; charset=utf-8" };

/** `folders`: from prefixes of addresses to folders. Returns the server and its address. */
export async function serve(port, folders) {
  const server = createServer(async (request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, "http://localhost").pathname));
    const prefix = Object.keys(folders).filter((p) => path.startsWith(p)).sort((a, b) => b.length - a.length)[0];
    const file = prefix && join(folders[prefix], path.slice(prefix.length) || "index.html");
    const known = file && !path.includes("..") && (await stat(file).catch(() => undefined))?.isFile();
    // Both headers isolate the page, which makes its clock twenty times as fine.
    response.writeHead(known ? 200 : 404, { "Content-Type": TYPES[extname(file ?? "")] ?? "application/octet-stream",
      "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp", "Cache-Control": "no-store" });
    if (known) createReadStream(file).pipe(response);
    else response.end("There is no such file.");
  });
  await new Promise((resolve, reject) => server.once("error", reject).listen(port, "127.0.0.1", resolve));
  return { server, address: `http://127.0.0.1:${server.address().port}/` };
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const [port, folder, ...others] = process.argv.slice(2);
  const folders = { "/": folder, ...Object.fromEntries(others.map((other) => other.split("="))) };
  const { address } = await serve(Number(port), folders);
  console.log(`The demo is at ${address} (Ctrl-C ends it)`);
}
