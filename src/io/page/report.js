// Draws the charts of a report with Vega: each <div class="plot"> names one chart of the page's data.
(function () {
  "use strict";
  const charts = JSON.parse(document.getElementById("charts").textContent);
  const tip = document.getElementById("tip");
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  function axis(scale, orient, title, more) {
    return Object.assign({ scale, orient, title, labelColor: css("--text"), titleColor: css("--text"),
      tickColor: css("--rule"), domainColor: css("--rule"), titleFontWeight: "normal", labelFontSize: 11,
      titleFontSize: 12, labelOverlap: true }, more);
  }
  const closed = (loop) => loop.concat([loop[0]]);
  const points = (loops) => loops.flatMap((loop, i) => closed(loop).map((p) => ({ loop: i, x: p[0], z: p[1] })));

  function outline(data, stroke, dash) {
    return {
      type: "group", from: { facet: { name: "one " + data, data, groupby: "loop" } }, interactive: false,
      marks: [{ type: "line", interactive: false, from: { data: "one " + data },
        encode: { enter: { x: { scale: "x", field: "x" }, y: { scale: "z", field: "z" }, stroke: { value: stroke },
          strokeWidth: { value: 1.6 }, strokeDash: { value: dash } } } }],
    };
  }

  // Twice, the first as a dark rim: readable on every colour.
  function label(fill, stroke) {
    return { type: "text", from: { data: "markers" }, interactive: false, encode: { enter: {
      x: { scale: "x", field: "x" }, y: { scale: "z", field: "z", offset: -16 }, text: { field: "label" },
      align: { value: "center" }, fill: { value: fill }, stroke: { value: stroke }, strokeWidth: { value: 3 },
      strokeJoin: { value: "round" }, fontWeight: { value: "bold" } } } };
  }

  // Seen from above, x to the right and z down the page.
  function map(chart, width) {
    const inner = width - 118, s = chart.spacing_m, x1 = chart.x0 + s * chart.columns, z1 = chart.z0 + s * chart.rows;
    const height = Math.round(inner * (z1 - chart.z0) / (x1 - chart.x0));
    const squares = [];
    chart.values.forEach((v, i) => {
      if (v === null) return;
      squares.push({ x: chart.x0 + s * (i % chart.columns), z: chart.z0 + s * Math.floor(i / chart.columns), v });
    });
    const text = "format(datum.x + " + s / 2 + ", '.2f') + ' m, ' + format(datum.z + " + s / 2 +
      ", '.2f') + ' m\\n' + datum.v + ' " + chart.unit + "'";
    return {
      width: inner, height, padding: 4,
      data: [{ name: "squares", values: squares }, { name: "outline", values: points(chart.outline) },
        { name: "dashed", values: points(chart.dashed) }, { name: "markers", values: chart.markers }],
      scales: [
        { name: "x", type: "linear", domain: [chart.x0, x1], range: "width", nice: false, zero: false },
        { name: "z", type: "linear", domain: [chart.z0, z1], range: [0, height], nice: false, zero: false },
        { name: "colour", type: "linear", domain: [0, chart.max], range: { scheme: "viridis" } },
      ],
      axes: [axis("x", "bottom", "x, m"), axis("z", "left", "z, m")],
      legends: [{ fill: "colour", title: chart.label, type: "gradient", gradientLength: Math.min(height, 220),
        labelColor: css("--text"), titleColor: css("--text"), titleFontWeight: "normal", titleLimit: 110 }],
      marks: [
        { type: "rect", from: { data: "squares" }, encode: { enter: {
          x: { scale: "x", field: "x" }, x2: { scale: "x", signal: "datum.x + " + s },
          y: { scale: "z", field: "z" }, y2: { scale: "z", signal: "datum.z + " + s },
          fill: { scale: "colour", field: "v" }, stroke: { scale: "colour", field: "v" }, strokeWidth: { value: 0.9 },
          tooltip: { signal: text } } } },
        outline("outline", css("--text"), [1, 0]), outline("dashed", "#ffffff", [6, 4]),
        { type: "symbol", from: { data: "markers" }, interactive: false, encode: { enter: {
          x: { scale: "x", field: "x" }, y: { scale: "z", field: "z" }, shape: { value: "triangle-up" },
          size: { value: 110 }, angle: { field: "angle_deg" }, fill: { value: "#ff4d6d" },
          stroke: { value: "#ffffff" }, strokeWidth: { value: 1.2 } } } },
        label("#000000", "#000000"), label("#ffffff", null),
      ],
    };
  }

  function histogram(chart, width) {
    const inner = width - 60, all = chart.values.concat(chart.real === null ? [] : [chart.real]);
    const low = Math.min(...all), high = Math.max(...all) + 1;
    const step = Math.max(1, Math.ceil((high - low) / 18));
    const first = Math.floor(low / step) * step, bins = [];
    for (let from = first; from < high; from += step) {
      const n = chart.values.filter((v) => v >= from && v < from + step).length;
      bins.push({ from, to: from + step, last: from + step - 1, n, share: n / chart.values.length });
    }
    const text = "(datum.from == datum.last ? datum.from : datum.from + ' to ' + datum.last) + ' " + chart.unit +
      "\\n' + datum.n + ' of " + chart.values.length + " runs'";
    const marks = [{ type: "rect", from: { data: "bins" }, encode: { enter: {
      x: { scale: "x", field: "from", offset: 0.5 }, x2: { scale: "x", field: "to", offset: -0.5 },
      y: { scale: "y", field: "share" }, y2: { scale: "y", value: 0 }, fill: { value: css("--bar") },
      tooltip: { signal: text } } } }];
    if (chart.real !== null) {
      marks.push({ type: "rule", encode: { enter: { x: { scale: "x", value: chart.real + 0.5 }, y: { value: 0 },
        y2: { signal: "height" }, stroke: { value: css("--real") }, strokeWidth: { value: 2.5 },
        tooltip: { value: "measured: " + chart.real + " " + chart.unit } } } });
    }
    return {
      width: inner, height: 110, padding: 4, data: [{ name: "bins", values: bins }],
      scales: [
        { name: "x", type: "linear", domain: [first, bins[bins.length - 1].to], range: "width", zero: false },
        { name: "y", type: "linear", domain: { data: "bins", field: "share" }, range: "height", nice: true, zero: true },
      ],
      axes: [axis("x", "bottom", chart.label, { tickCount: 5 }), axis("y", "left", "share of runs", { tickCount: 4, format: "%" })],
      marks,
    };
  }

  function series(chart, width) {
    const inner = width - 90, seen = [];
    chart.rows.forEach((row) => row.times_s.forEach((t) => seen.push({ row: row.name, t })));
    const text = "datum.row + ', ' + format(datum.t - " + chart.window_s + ", ',') + ' to ' + format(datum.t, ',') + ' s: motion'";
    return {
      width: inner, height: 26 * chart.rows.length + 8, padding: 4,
      data: [{ name: "seen", values: seen }, { name: "phases", values: chart.phases }],
      scales: [
        { name: "x", type: "linear", domain: [0, chart.end_s], range: "width", nice: false },
        { name: "y", type: "band", domain: chart.rows.map((row) => row.name), range: "height", padding: 0.25 },
      ],
      axes: [axis("x", "bottom", "time, s"), axis("y", "left", null)],
      marks: [
        { type: "rect", from: { data: "phases" }, encode: { enter: { x: { scale: "x", field: "from_s" },
          x2: { scale: "x", field: "to_s" }, y: { value: 0 }, y2: { signal: "height" }, fill: { value: css("--mark") },
          fillOpacity: { value: 0.1 }, tooltip: { signal: "datum.name + ', ' + datum.from_s + ' to ' + datum.to_s + ' s'" } } } },
        { type: "rect", from: { data: "seen" }, encode: { enter: {
          x: { scale: "x", signal: "datum.t - " + chart.window_s }, x2: { scale: "x", field: "t" },
          y: { scale: "y", field: "row" }, height: { scale: "y", band: 1 }, fill: { value: css("--text") },
          tooltip: { signal: text } } } },
      ],
    };
  }

  function showTip(handler, event, item, value) {
    if (value === null || value === undefined || value === "") { tip.style.visibility = "hidden"; return; }
    tip.textContent = value;
    tip.style.visibility = "visible";
    const left = Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 6);
    tip.style.left = Math.max(4, left) + "px";
    tip.style.top = Math.max(4, event.clientY - tip.offsetHeight - 10) + "px";
  }

  const makers = { map, histogram, series }, views = new Map();
  function draw(place) {
    const chart = charts[Number(place.dataset.chart)];
    const width = Math.floor(place.clientWidth) - 8;
    if (width < 60) return;
    if (views.has(place)) views.get(place).finalize();
    const spec = Object.assign({ background: null, config: { text: { font: "system-ui, sans-serif" } } }, makers[chart.kind](chart, width));
    const view = new vega.View(vega.parse(spec), { renderer: "canvas", container: place, hover: false });
    view.tooltip(showTip).initialize(place);
    views.set(place, view);
    place.dataset.width = String(place.clientWidth);
    view.runAsync().catch((fault) => { console.error(fault); place.textContent = "This chart can't be drawn."; });
  }

  // Charts are drawn when they come near the window: a study of fifty cells opens at once.
  const places = Array.from(document.querySelectorAll(".plot"));
  function drawNearby() {
    places.forEach((place) => {
      const box = place.getBoundingClientRect();
      if (!views.has(place) && box.top < window.innerHeight + 600 && box.bottom > -600) draw(place);
    });
  }
  const redraw = () => views.forEach((view, place) => draw(place));
  drawNearby();
  window.addEventListener("scroll", drawNearby, { passive: true });
  let waiting = 0;
  window.addEventListener("resize", () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => {
      views.forEach((view, place) => { if (place.dataset.width !== String(place.clientWidth)) draw(place); });
      drawNearby();
    }, 150);
  });
  window.addEventListener("beforeprint", () => places.filter((place) => !views.has(place)).forEach(draw));
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
})();
