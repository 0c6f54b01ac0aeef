/** One colour a joint, the same in chips, curves and lists. */

const HUES = [255, 35, 150, 325, 85, 205, 10, 120, 290, 60, 180, 345];

/** Colour of a joint as #rrggbb, legible on the page's background. */
export function jointColour(index, isDark) {
  const round = Math.floor(index / HUES.length);
  const lightness = (isDark ? 0.76 : 0.56) + (index % 2 ? 0.05 : -0.02) - 0.1 * round * (isDark ? 1 : -1);
  return fromOklch(lightness, 0.135, HUES[index % HUES.length]);
}

/** OKLCH (lightness 0..1, chroma, hue in degrees) as #rrggbb, clipped. */
function fromOklch(lightness, chroma, hue) {
  const [a, b] = [Math.cos((hue * Math.PI) / 180) * chroma, Math.sin((hue * Math.PI) / 180) * chroma];
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  const linear = [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
  const byte = (value) => {
    const clipped = Math.min(1, Math.max(0, value));
    const curved = clipped <= 0.0031308 ? 12.92 * clipped : 1.055 * clipped ** (1 / 2.4) - 0.055;
    return Math.round(255 * curved)
      .toString(16)
      .padStart(2, '0');
  };
  return `#${linear.map(byte).join('')}`;
}
