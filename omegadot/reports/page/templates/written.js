// A number for people, as the page's text has it: 0.005, 2.8e6, 3.1e-15.
function written(number, digits = 6) {
  const [mantissa, power] = number.toExponential(digits - 1).split("e"), exponent = Number(power);
  if (Number(mantissa) === 0) return "0";
  return exponent >= -4 && exponent < Math.max(5, digits) ? String(Number(`${mantissa}e${power}`)) : `${Number(mantissa)}e${exponent}`;
}
