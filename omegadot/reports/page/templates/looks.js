// How every chart looks: colours out of the page's style, logarithmic axes, a marked lowest line.
const dark = matchMedia("(prefers-color-scheme: dark)");
const narrow = matchMedia("(max-width: 40rem)");
const coarse = matchMedia("(pointer: coarse)");
let printing = false;

const style = getComputedStyle(root);
const colour = (name) => style.getPropertyValue(name).trim();
const ownColour = ([light, night]) => (dark.matches && !printing ? night : light);
const dashOf = (look) => look.dash.replaceAll(" ", "px,") + (look.dash && "px") || "solid";
const unitText = (unit) => (unit === "1" ? "" : ` ${unit}`);
const settings = { displayModeBar: false, responsive: true, doubleClick: false };

function value(code, data) {
  if (code === 65535) return null;
  if (code === 0) return 10 ** data.floor;
  return 10 ** (data.floor + ((code - 1) / 65533) * (data.ceiling - data.floor));
}

const axisLook = () => ({ gridcolor: colour("--grid"), linecolor: colour("--rule"), zeroline: false, tickcolor: colour("--rule") });
const levelLine = (level, dash) => ({ type: "line", xref: "paper", x0: 0, x1: 1, y0: level, y1: level, line: { color: colour("--soft"), width: 1, dash }, layer: "below" });
const levelName = (level, text, side, anchor) => ({
  xref: "paper", x: side === "right" ? 1 : 0, xanchor: side, yref: "y", y: Math.log10(level), yanchor: anchor,
  showarrow: false, text, font: { size: 11, color: colour("--soft") }, bgcolor: colour("--panel"), opacity: 0.85, borderpad: 1,
});

function layout(axis, data) {
  // Below the lowest line there is room for its label.
  const high = axis.high + 0.1, low = axis.floor ? data.floor - 0.1 * (high - data.floor) : axis.low - 0.1;
  const shapes = [], annotations = [];
  if (axis.floor) {
    shapes.push(levelLine(10 ** data.floor, "dot"));
    annotations.push(levelName(10 ** data.floor, `zero to 10<sup>${data.floor}</sup> is drawn here`, "right", "top"));
  }
  if (axis.resolvable) {
    shapes.push(levelLine(axis.resolvable, "dashdot"));
    annotations.push(levelName(axis.resolvable, "floor", "right", "bottom"));
  }
  return {
    autosize: true, margin: { l: 58, r: 18, t: 12, b: 40 }, showlegend: false, hovermode: "closest",
    dragmode: coarse.matches ? false : "zoom",
    paper_bgcolor: colour("--panel"), plot_bgcolor: colour("--panel"),
    font: { family: style.getPropertyValue("--sans"), size: 12, color: colour("--soft") },
    hoverlabel: { align: "left" },
    xaxis: { ...axisLook(), title: { text: "time, s", standoff: 6 } },
    yaxis: { ...axisLook(), type: "log", range: [low, high], exponentformat: "power", dtick: Math.max(1, Math.ceil((high - low) / 8)) },
    shapes, annotations,
  };
}
