// From linear light to the display: the only file that is not physics.

// Rec. 709 primaries.
Number luminance(Number r, Number g, Number b) {
  return Number(0.2126) * r + Number(0.7152) * g + Number(0.0722) * b;
}

// ACES reference and output transforms as one rational curve (fit by S. Hill), of one channel.
// Above the cap it is within 4e-6 of its end, and v * v could overflow.
Number aces_curve(Number light) {
  Number v = min(max(light, Number(0.0)), Number(1e5));
  Number top = v * (v + Number(0.0245786)) - Number(0.000090537);
  return top / (v * (Number(0.983729) * v + Number(0.4329510)) + Number(0.238081));
}

// Linear Rec. 709 light to linear display values in [0, 1].
void aces_tone(Number r, Number g, Number b, OUT(Number) r_shown, OUT(Number) g_shown,
               OUT(Number) b_shown) {
  Number x = aces_curve(Number(0.59719) * r + Number(0.35458) * g + Number(0.04823) * b);
  Number y = aces_curve(Number(0.07600) * r + Number(0.90834) * g + Number(0.01566) * b);
  Number z = aces_curve(Number(0.02840) * r + Number(0.13383) * g + Number(0.83777) * b);
  Number red = Number(1.60475) * x - Number(0.53108) * y - Number(0.07367) * z;
  Number green = Number(-0.10208) * x + Number(1.10813) * y - Number(0.00605) * z;
  Number blue = Number(-0.00327) * x - Number(0.07276) * y + Number(1.07602) * z;
  r_shown = min(max(red, Number(0.0)), Number(1.0));
  g_shown = min(max(green, Number(0.0)), Number(1.0));
  b_shown = min(max(blue, Number(0.0)), Number(1.0));
}

// IEC 61966-2-1. value in [0, 1].
Number srgb_encode(Number value) {
  if (value <= Number(0.0031308)) return Number(12.92) * value;
  return Number(1.055) * pow(value, Number(1.0 / 2.4)) - Number(0.055);
}
