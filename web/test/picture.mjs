// Draws the README's picture of the page: node test/picture.mjs FILE (tools/web --picture)
import { writeFile } from "node:fs/promises";
import { serve } from "../serve.mjs";
import { openBrowser, openDemo } from "./browser.mjs";

const { server, address } = await serve(0, { "/": process.env.ORCHARD_SITE });
const { browser, close } = await openBrowser();
try {
  const { page } = await openDemo(browser, address, { width: 1180, height: 640 });
  await writeFile(process.argv[2], await page.screenshot());
} finally {
  await close();
  server.close();
}
