import { Color } from "three";

/** Viridis at equal steps, from dark to light: equal steps of a value look equally large, also in grey. */
const VIRIDIS = ["#440154", "#482475", "#414487", "#355f8d", "#2a788e", "#21918c", "#22a884", "#44bf70", "#7ad151", "#bddf26", "#fde725"]
  .map((hex) => new Color(hex));

/** Of a share from 0 to 1; what is outside takes the nearest end. */
export function viridis(share: number, to = new Color()): Color {
  const place = Math.min(Math.max(share, 0), 1) * (VIRIDIS.length - 1);
  const below = Math.min(Math.floor(place), VIRIDIS.length - 2);
  return to.copy(VIRIDIS[below]!).lerp(VIRIDIS[below + 1]!, place - below);
}
export const VIRIDIS_CSS = `linear-gradient(90deg, ${VIRIDIS.map((c) => `#${c.getHexString()}`).join(", ")})`;

/** Parts of an axis: sheets that lie side by side get colours that differ, all of about the same lightness. */
export function sheetColor(number: number, to = new Color()): Color {
  return to.setHSL((0.47 + number * 0.381966) % 1, 0.42, 0.58);
}
export const LINES = { seam: "#d1495b", border: "#2a788e", curve: "#e0a030" } as const;
/** Where a thickness is not defined. */
export const NONE = new Color("#9a9d99");
