// A headless Chromium of the system, and what tests need of a page.
import { existsSync } from "node:fs";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import puppeteer from "puppeteer-core";

const NAMES = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
export const chromium = () => process.env.CHROMIUM ?? NAMES.find(existsSync);

/** Opens a browser with a folder of its own, which close() removes. */
export async function openBrowser() {
  const profile = await mkdtemp(join(tmpdir(), "orchard-web-"));
  const browser = await puppeteer.launch({
    executablePath: chromium(), headless: true, userDataDir: profile, protocolTimeout: 240_000,
    args: ["--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader",
      "--disable-background-networking", "--disable-component-update", "--disable-sync", "--no-first-run", "--mute-audio",
      "--force-device-scale-factor=1", "--hide-scrollbars"],
  });
  return { browser, close: async () => {
    await browser.close();
    await rm(profile, { recursive: true, force: true, maxRetries: 5 });
  } };
}

/** A page of the demo that is ready. `seen` collects requests to other hosts, and errors. */
export async function openDemo(browser, address, { width = 1280, height = 800, hash = "", dark = false } = {}) {
  const page = await browser.newPage();
  const seen = { foreign: [], errors: [] };
  page.on("request", (request) => {
    if (!request.url().startsWith(address) && !/^(data|blob):/.test(request.url())) seen.foreign.push(request.url());
  });
  page.on("pageerror", (error) => seen.errors.push(error.message));
  page.on("console", (message) => message.type() === "error" && seen.errors.push(message.text()));
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: dark ? "dark" : "light" },
    { name: "prefers-reduced-motion", value: "reduce" }]);
  await page.setViewport({ width, height, isMobile: width < 500, hasTouch: width < 500 });
  await page.goto(`${address}${hash}`, { waitUntil: "load" });
  await page.waitForSelector("body[data-ready=true]", { timeout: 60_000 });
  await page.evaluate(() => document.fonts.ready);
  await settle(page);
  return { page, seen };
}

/** Until what was asked for has been drawn. */
export function settle(page) {
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done)))));
}

/** Clicks without scrolling to it by a pointer: works for what is covered, too. */
export const press = (page, selector) => page.$eval(selector, (element) => element.click());

export function slide(page, selector, value) {
  return page.$eval(selector, (element, to) => {
    element.value = to;
    element.dispatchEvent(new Event("input", { bubbles: true }));
  }, String(value));
}
