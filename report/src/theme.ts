// Light and dark: that of the system unless one is chosen.

type Colour = [number, number, number];

function variable(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Returns red, green and blue, from 0 to 1, of a colour like #0072b2. */
export function channels(colour: string): Colour {
  const value = Number.parseInt(colour.replace("#", ""), 16);
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

/** Returns the colours of mode shapes. */
export function palette(): { body: Colour; model: Colour; data: Colour; ink: string; faint: string } {
  return {
    body: channels(variable("--body")),
    model: channels(variable("--series-1")),
    data: channels(variable("--series-2")),
    ink: variable("--edge-ink"),
    faint: variable("--faint"),
  };
}

/** Returns the colour between two ends for a value from 0 to 1, and one that is read upon it. */
export function mixed(t: number): { background: string; ink: string } {
  const low = channels(variable("--ramp-low"));
  const high = channels(variable("--ramp-high"));
  const mix = low.map((x, c) => x + t * (high[c] - x)) as Colour;
  const light = luminance(mix);
  const onDark = 1.05 / (light + 0.05);
  const onLight = (light + 0.05) / 0.05;
  return {
    background: `rgb(${mix.map((x) => Math.round(255 * x)).join(",")})`,
    ink: onLight > onDark ? "#000000" : "#ffffff",
  };
}

function luminance(colour: Colour): number {
  const [r, g, b] = colour.map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** Returns the button that turns to the other theme. */
export function themeButton(): HTMLButtonElement {
  const button = document.createElement("button");
  button.type = "button";
  const root = document.documentElement;
  const system = matchMedia("(prefers-color-scheme: dark)");
  const isDark = (): boolean => (root.dataset.theme ?? (system.matches ? "dark" : "light")) === "dark";
  const name = (): void => {
    button.textContent = isDark() ? "Light" : "Dark";
    button.setAttribute("aria-label", isDark() ? "light colours" : "dark colours");
  };
  button.addEventListener("click", () => {
    root.dataset.theme = isDark() ? "light" : "dark";
    name();
    document.dispatchEvent(new Event("themechange"));
  });
  system.addEventListener("change", () => {
    name();
    document.dispatchEvent(new Event("themechange"));
  });
  name();
  return button;
}
