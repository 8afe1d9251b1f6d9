// Numbers as text.

const MINUS = "−";

/** Returns a number with so many significant digits; a dash where there is none. */
export function number(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined || Number.isNaN(x)) return "–";
  if (!Number.isFinite(x)) return x > 0 ? "∞" : `${MINUS}∞`;
  if (x === 0) return "0";
  const size = Math.abs(x);
  const text =
    size >= 1e6 || size < 1e-4
      ? x.toExponential(digits - 1).replace("e+", "e")
      : x.toPrecision(digits).includes("e")
        ? String(Math.round(x))
        : x.toPrecision(digits);
  return text.replace(/-/g, MINUS);
}

/** Returns a parameter with its standard deviation, or with what holds or leaves it. */
export function scattered(x: number | null, std: number | null, bounds: readonly (number | null)[]): string {
  const value = number(x);
  if (std === 0) return value + (x === bounds[0] ? ", at its lower bound" : x === bounds[1] ? ", at its upper bound" : "");
  if (std === null) return value;
  return Number.isFinite(std) ? `${value} ± ${number(std, 2)}` : `${value}, open`;
}

/** Returns an interval in digits that tell its ends apart. */
export function between([low, high]: [number, number]): string {
  const apart = Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / (high - low))) + 1;
  const digits = Math.min(Math.max(3, Number.isFinite(apart) ? apart : 3), 9);
  return `${number(low, digits)}–${number(high, digits)}`;
}

/** Returns a number with so many digits behind the point. */
export function fixed(x: number | null | undefined, digits: number, signed = false): string {
  if (x === null || x === undefined || !Number.isFinite(x)) return number(x);
  const text = x.toFixed(digits);
  if (Number(text) === 0) return text.replace("-", "");
  return (signed && x > 0 ? `+${text}` : text).replace("-", MINUS);
}

/** Returns a short text for a tick. */
export function tick(x: number): string {
  const size = Math.abs(x);
  if (x !== 0 && (size >= 1e5 || size < 1e-3)) {
    return x.toExponential().replace("e+", "e").replace(/-/g, MINUS);
  }
  return String(Number(x.toPrecision(6))).replace("-", MINUS);
}

/** Returns a ratio as one says it: in % where it is small, in powers of ten where it is huge. */
export function times(ratio: number): string {
  if (ratio < 2) return `by ${Number((100 * (ratio - 1)).toPrecision(2))} %`;
  if (ratio < 10) return `by a factor of ${Number(ratio.toPrecision(2))}`;
  if (ratio < 1e6) return `by a factor of ${Number(ratio.toPrecision(2)).toLocaleString("en")}`;
  return `by more than ${Math.floor(Math.log10(ratio))} powers of ten`;
}
