// Shared by the pages: elements, numbers, tables, axis ticks.
const COLOURS = ["#2f7ed8", "#e4572e", "#2aa876", "#a05ec9", "#c98a1b", "#d6489a", "#4d6a80", "#7f9c2e"];
const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const make = (tag, attributes, ...children) => {
  const e = document.createElement(tag);
  for (const [k, v] of Object.entries(attributes || {})) k === "style" ? e.style.cssText = v : e.setAttribute(k, v);
  for (const c of children) if (c !== null && c !== undefined) e.append(c);
  return e;
};
const num = (x, digits = 4) => x === null || x === undefined || !isFinite(x) ? "–" :
  x === 0 ? "0" : Math.abs(x) >= 1e5 || Math.abs(x) < 1e-3 ? x.toExponential(2) : String(+x.toPrecision(digits));
const time = s => s === null || s === undefined ? "–" : s >= 1 ? num(s) + " s" : s >= 1e-3 ? num(s * 1e3) + " ms" : num(s * 1e6) + " µs";
const section = (title, ...content) => page.append(make("h2", {}, title), ...content);
const table = (heads, rows) => {
  const t = make("table"), h = make("tr");
  for (const [text, cls] of heads) h.append(make("th", { class: cls || "" }, text));
  t.append(h);
  for (const row of rows) {
    const tr = make("tr");
    row.forEach((cell, i) => tr.append(make("td", { class: (cell && cell.cls) || heads[i][1] || "" },
      cell && cell.node !== undefined ? cell.node : cell && cell.text !== undefined ? cell.text : cell)));
    t.append(tr);
  }
  return t;
};
const ticks = (low, high, n) => {
  const raw = (high - low) / n, power = Math.pow(10, Math.floor(Math.log10(raw)));
  const step = [1, 2, 5, 10].map(m => m * power).find(s => s >= raw);
  const out = [];
  for (let x = Math.ceil(low / step) * step; x <= high + step * 1e-9; x += step) out.push(Math.abs(x) < step * 1e-9 ? 0 : x);
  return out;
};
