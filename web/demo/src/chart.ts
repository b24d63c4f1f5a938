export interface Series {
  values: readonly number[];
  /** A colour of the style sheet. */
  color: string;
}

/** Means of a few steps over time, on a logarithmic scale, as lines. */
export class Chart {
  constructor(private readonly canvas: HTMLCanvasElement) {}

  draw(series: readonly Series[], mean: number): void {
    const { canvas } = this, context = canvas.getContext("2d");
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (!context || width === 0) return;
    const ratio = devicePixelRatio;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    context.scale(ratio, ratio);
    const lines = series.map(({ values, color }) => ({ color, values: means(values, mean) }));
    const style = getComputedStyle(document.documentElement);
    const low = 0.001, high = 2, left = 44, right = width - 4, top = 8, bottom = height - 10;
    const y = (ms: number) => bottom - ((Math.log(Math.max(ms, low)) - Math.log(low)) / (Math.log(high) - Math.log(low))) * (bottom - top);
    context.font = "11px Inter, system-ui, sans-serif";
    context.textBaseline = "middle";
    for (const tick of [0.001, 0.01, 0.1, 1]) {
      context.fillStyle = style.getPropertyValue("--soft");
      context.fillText(tick === 1 ? "1 ms" : String(tick), 0, y(tick));
      context.fillStyle = style.getPropertyValue("--line");
      context.fillRect(left, Math.round(y(tick)), right - left, 1);
    }
    for (const { values, color } of lines) {
      context.strokeStyle = style.getPropertyValue(color);
      context.lineWidth = 2;
      context.lineJoin = "round";
      context.beginPath();
      values.forEach((value, i) => context.lineTo(left + ((right - left) * i) / Math.max(values.length - 1, 1), Math.max(y(value), top)));
      context.stroke();
    }
  }
}

/** The mean of up to `count` values that end at each one. */
function means(values: readonly number[], count: number): number[] {
  let sum = 0;
  return values.map((value, i) => {
    sum += value - (i >= count ? values[i - count]! : 0);
    return sum / Math.min(i + 1, count);
  });
}
