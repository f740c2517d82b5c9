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

  // Walls that were cut through, and lines of those without thickness, as SVG paths in the map's pixels. With a light
  // rim, which shows where the floor is dark. The floor's edge stands for walls outside of the squares.
  function walls(chart, toPixels) {
    const path = (loop) => loop.map((p, i) => (i ? "L" : "M") + toPixels(p).map((v) => v.toFixed(2)).join(",")).join("");
    const areas = chart.walls.map((loops) => ({ d: loops.map((loop) => path(loop) + "Z").join("") }));
    const lines = chart.wall_lines.map((line) => ({ d: path(line) }));
    const mark = (data, fill, stroke, width) => ({ type: "path", from: { data }, interactive: false, clip: true,
      encode: { enter: { x: { value: 0 }, y: { value: 0 }, path: { field: "d" }, fill: { value: fill }, stroke: { value: stroke },
        strokeWidth: { value: width } } } });
    return {
      data: [{ name: "walls", values: areas }, { name: "wall lines", values: lines }],
      marks: [mark("walls", "transparent", "#ffffff", 3), mark("wall lines", "transparent", "#ffffff", 4),
        mark("walls", "#000000", "#000000", 1), mark("wall lines", "transparent", "#000000", 2)],
    };
  }

  // Names beside their signs, those of markers first. One that would cover another name or a sign is left out: its
  // own sign tells it when pointed at.
  function names(chart, toPixels, width, height) {
    const pen = document.createElement("canvas").getContext("2d"), taken = [], placed = [];
    const boxAt = (x, y, wide, high) => ({ left: x - wide / 2, right: x + wide / 2, top: y - high / 2, bottom: y + high / 2 });
    const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    const isFree = (box) => box.left > -4 && box.right < width + 4 && box.top > -14 && box.bottom < height + 14 &&
      !taken.some((other) => overlap(box, other));
    function place(sign, size, ways) {
      const [x, y] = toPixels([sign.x, sign.z]);
      pen.font = `bold ${size}px system-ui, sans-serif`;
      const wide = pen.measureText(sign.label).width + 4, high = size + 3;
      const places = ways(wide).map(([right, down]) => [x + right, y + down]);
      const at = places.find(([px, py]) => isFree(boxAt(px, py, wide, high)));
      if (!at) return;
      taken.push(boxAt(...at, wide, high));
      placed.push({ x: at[0], y: at[1], label: sign.label, size });
    }
    const signs = [...chart.people, ...chart.markers];
    signs.forEach(({ x, z }) => taken.push(boxAt(...toPixels([x, z]), 12, 12)));
    chart.seats.forEach(({ x, z }) => taken.push(boxAt(...toPixels([x, z]), 6, 6)));
    chart.areas.forEach((area) => place(area, 13, () => [0, -16, 16, -32, 32, -48, 48].map((down) => [0, down])));
    signs.forEach((sign) => place(sign, 11, (wide) => [[0, -14], [0, 15], [wide / 2 + 9, 0], [-wide / 2 - 9, 0],
      [0, -26], [0, 27], [wide / 2, -20], [-wide / 2, -20], [wide / 2, 20], [-wide / 2, 20]]));
    // Where a seat's name has room: behind the back of whoever sits there.
    chart.seats.forEach((seat) => {
      const turn = seat.angle_deg * Math.PI / 180, away = 13;
      place(seat, 9, (wide) => [[-away * Math.sin(turn), away * Math.cos(turn)], [0, 11], [0, -11], [wide / 2 + 6, 0], [-wide / 2 - 6, 0]]);
    });
    return placed;
  }
  // Twice, the first as a dark rim: readable on every colour.
  const label = (fill, stroke) => ({ type: "text", name: stroke ? "rims of names" : "names", from: { data: "placed" },
    interactive: false, encode: { enter: {
      x: { field: "x" }, y: { field: "y" }, text: { field: "label" }, align: { value: "center" }, baseline: { value: "middle" },
      fontSize: { field: "size" }, fill: { value: fill }, stroke: { value: stroke }, strokeWidth: { value: 3 },
      strokeJoin: { value: "round" }, fontWeight: { value: "bold" } } } });

  // Pale for the first class, then from light to dark.
  const classColours = ["#eef1f4", "#fdd49e", "#fdbb84", "#ef6548", "#b30000", "#5a0000"];

  // Seen from above, x to the right and z down the page.
  function map(chart, width) {
    const inner = width - (chart.classes.length ? 172 : 140), s = chart.spacing_m;  // the rest is the legend's
    const x1 = chart.x0 + s * chart.columns, z1 = chart.z0 + s * chart.rows;
    const height = Math.round(inner * (z1 - chart.z0) / (x1 - chart.x0));
    const toPixels = ([x, z]) => [(x - chart.x0) / (x1 - chart.x0) * inner, (z - chart.z0) / (z1 - chart.z0) * height];
    const classOf = (v) => chart.classes.filter(({ above }) => v > above).pop().name;
    const squares = [];
    chart.values.forEach((v, i) => {
      if (v === null) return;
      squares.push({ x: chart.x0 + s * (i % chart.columns), z: chart.z0 + s * Math.floor(i / chart.columns), v,
        colour: chart.classes.length ? classOf(v) : chart.pass_or_fail ? (v === 1 ? "pass" : "fail") : v,
        told: chart.pass_or_fail ? (v === 1 ? "pass" : "fail") : v });
    });
    const text = "format(datum.x + " + s / 2 + ", '.2f') + ' m, ' + format(datum.z + " + s / 2 +
      ", '.2f') + ' m\\n' + datum.told + ' " + chart.unit + "'";
    const at = { x: { scale: "x", field: "x" }, y: { scale: "z", field: "z" } };
    const wall = walls(chart, toPixels), colours = chart.classes.length
      ? { type: "ordinal", domain: chart.classes.map(({ name }) => name), range: classColours }
      : chart.pass_or_fail ? { type: "ordinal", domain: ["pass", "fail"], range: ["#7fb8e6", "#e0a458"] }
      : { type: "linear", domain: [0, chart.max], range: { scheme: "viridis" } };
    const isScale = colours.type === "linear";
    return {
      width: inner, height, padding: 4,
      data: [{ name: "squares", values: squares }, { name: "outline", values: points(chart.outline) },
        { name: "areas", values: points(chart.areas.flatMap(({ loops }) => loops)) },
        { name: "furniture", values: points(chart.furniture) }, { name: "dashed", values: points(chart.dashed) },
        { name: "markers", values: chart.markers }, { name: "people", values: chart.people }, { name: "seats", values: chart.seats },
        { name: "ringed", values: chart.ringed },
        { name: "placed", values: names(chart, toPixels, inner, height) }, { name: "doors", values: chart.doors },
        { name: "sweeps", values: points(chart.sweeps) }, ...wall.data],
      scales: [
        { name: "x", type: "linear", domain: [chart.x0, x1], range: "width", nice: false, zero: false },
        { name: "z", type: "linear", domain: [chart.z0, z1], range: [0, height], nice: false, zero: false },
        Object.assign({ name: "colour" }, colours),
      ],
      axes: [axis("x", "bottom", "x, m"), axis("z", "left", "z, m")],
      legends: [Object.assign({ fill: "colour", title: chart.label, labelColor: css("--text"),
        titleColor: css("--text"), titleFontWeight: "normal", titleLimit: 140 },
        isScale ? { type: "gradient", gradientLength: Math.min(height, 220) } : { symbolType: "square", symbolSize: 150 })],
      marks: [
        { type: "rect", from: { data: "squares" }, encode: { enter: {
          x: { scale: "x", field: "x" }, x2: { scale: "x", signal: "datum.x + " + s },
          y: { scale: "z", field: "z" }, y2: { scale: "z", signal: "datum.z + " + s },
          fill: { scale: "colour", field: "colour" }, stroke: { scale: "colour", field: "colour" }, strokeWidth: { value: 0.9 },
          tooltip: { signal: text } } } },
        outline("areas", "#ffffff", [1, 0]), outline("areas", "#823caa", [6, 4]),
        outline("furniture", "#000000", [1, 0]), outline("furniture", "#ffffff", [3, 3]), ...wall.marks,
        outline("outline", css("--text"), [1, 0]), outline("dashed", "#ffffff", [6, 4]),
        outline("sweeps", "#2da44e", [1, 0]),
        { type: "rule", from: { data: "doors" }, encode: { enter: Object.assign({ x2: { scale: "x", field: "x2" },
          y2: { scale: "z", field: "z2" }, stroke: { value: "#2da44e" }, strokeWidth: { value: 5 },
          tooltip: { signal: "'door ' + datum.label" } }, at) } },
        { type: "symbol", from: { data: "seats" }, encode: { enter: Object.assign({ shape: { value: "triangle-up" },
          size: { value: 45 }, angle: { field: "angle_deg" }, fill: { value: "#ffffff" }, stroke: { value: "#000000" },
          strokeWidth: { value: 1 }, tooltip: { signal: "'seat ' + datum.label" } }, at) } },
        { type: "symbol", from: { data: "ringed" }, encode: { enter: Object.assign({ shape: { value: "circle" },
          size: { value: 260 }, stroke: { value: "#ff7f0e" }, strokeWidth: { value: 3 },
          tooltip: { field: "label" } }, at) } },
        { type: "symbol", from: { data: "markers" }, encode: { enter: Object.assign({ shape: { value: "triangle-up" },
          size: { value: 110 }, angle: { field: "angle_deg" }, fill: { value: "#ff4d6d" }, stroke: { value: "#ffffff" },
          strokeWidth: { value: 1.2 }, tooltip: { field: "label" } }, at) } },
        { type: "symbol", from: { data: "people" }, encode: { enter: Object.assign({ shape: { value: "circle" },
          size: { value: 110 }, fill: { value: "#1f6feb" }, stroke: { value: "#ffffff" }, strokeWidth: { value: 1.2 },
          tooltip: { field: "label" } }, at) } },
        label("#000000", "#000000"), label("#ffffff", null),
      ],
    };
  }

  function histogram(chart, width) {
    const inner = width - 74, runs = chart.counts.reduce((sum, [, times]) => sum + times, 0);
    const all = chart.counts.map(([count]) => count).concat(chart.real === null ? [] : [chart.real]);
    const low = Math.min(...all), high = Math.max(...all) + 1;
    const step = Math.max(1, Math.ceil((high - low) / 18));
    const first = Math.floor(low / step) * step, bins = [];
    for (let from = first; from < high; from += step) {
      const n = chart.counts.reduce((sum, [count, times]) => sum + (count >= from && count < from + step ? times : 0), 0);
      bins.push({ from, to: from + step, last: from + step - 1, n, share: n / runs });
    }
    // Whole numbers: of one count a bar, under its middle.
    const ticks = step > 1 ? { tickCount: 5, tickMinStep: 1, format: "d" } : {
      values: bins.filter((bin, i) => i % Math.ceil(bins.length / 6) === 0).map((bin) => bin.from + 0.5),
      encode: { labels: { update: { text: { signal: "format(datum.value - 0.5, 'd')" } } } } };
    const text = "(datum.from == datum.last ? datum.from : datum.from + ' to ' + datum.last) + ' " + chart.unit +
      "\\n' + datum.n + ' of " + runs + " runs'";
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
      axes: [axis("x", "bottom", chart.label, ticks), axis("y", "left", "share of runs", { tickCount: 4, format: "%" })],
      marks,
    };
  }

  // Where a clock stands at whole steps, for a chart in seconds of a run whose rows have a clock.
  function clockTicks(chart, begin, width) {
    if (!chart.first_clock) return {};
    const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400];
    const step = steps.find((one) => one / chart.end_s * width >= 70) || 28800, values = [];
    for (let t = Math.ceil(begin / step) * step - begin; t <= chart.end_s; t += step) values.push(t);
    const text = `utcFormat(1000 * (datum.value + ${begin}), '${step % 60 === 0 ? "%H:%M" : "%H:%M:%S"}')`;
    return { values, encode: { labels: { update: { text: { signal: text } } } } };
  }

  function series(chart, width) {
    const named = chart.rows.map((row) => row.name), inner = width - longest(named, 40, 170) - 44, seen = [];
    chart.rows.forEach((row) => row.times_s.forEach((t) => seen.push({ row: row.name, t })));
    // The number of people has a strip of its own above the sensors.
    const strip = chart.people.length > 0 ? 56 : 0, gap = strip > 0 ? 10 : 0;
    const people = chart.people.map((p, i) => ({ x: p.from_s, n: p.n, low: p.low ?? p.n, high: p.high ?? p.n,
      x2: i + 1 < chart.people.length ? chart.people[i + 1].from_s : chart.end_s })).filter((p) => p.n !== null);
    const most = Math.max(1, ...people.map((p) => p.high));
    const rows = 26 * chart.rows.length + 8, height = strip + gap + rows;
    const begin = chart.first_clock ? Math.ceil(Date.parse(chart.first_clock + "Z") / 1000 - chart.window_s - 1e-6) : 0;
    // A moment, given as an expression, as the rows tell it.
    const moment = (t) => chart.first_clock ? `utcFormat(1000 * (${t} + ${begin}), '%H:%M:%S')` : `format(${t}, ',')`;
    const unit = chart.first_clock ? "" : " s";
    const text = `datum.row + ', ' + ${moment("(datum.t - " + chart.window_s + ")")} + ' to ' + ${moment("datum.t")} + '${unit}: motion'`;
    return {
      width: inner, height, padding: 4,
      data: [{ name: "seen", values: seen }, { name: "phases", values: chart.phases },
        { name: "people", values: people }],
      scales: [
        { name: "x", type: "linear", domain: [0, chart.end_s], range: "width", nice: false },
        { name: "y", type: "band", domain: chart.rows.map((row) => row.name), range: [strip + gap, height], padding: 0.25 },
        { name: "n", type: "linear", domain: [0, most], range: [strip, 0], zero: true },
      ],
      axes: [axis("x", "bottom", chart.first_clock ? "time of day" : "time, s", clockTicks(chart, begin, inner)),
        axis("y", "left", null, { labelLimit: 170 })].concat(
        strip > 0 ? [axis("n", "left", "people", { tickCount: Math.min(most, 4), format: "d" })] : []),
      marks: [
        { type: "rect", from: { data: "people" }, encode: { enter: { x: { scale: "x", field: "x" },
          x2: { scale: "x", field: "x2" }, y: { scale: "n", field: "low" }, y2: { scale: "n", value: 0 },
          fill: { value: css("--mark") }, fillOpacity: { value: 0.45 } } } },
        { type: "rule", from: { data: "people" }, encode: { enter: { x: { scale: "x", field: "x" },
          x2: { scale: "x", field: "x2" }, y: { scale: "n", field: "n" }, stroke: { value: css("--mark") },
          strokeWidth: { signal: "datum.low < datum.high ? 2 : 0" } } } },
        { type: "rect", from: { data: "people" }, encode: { enter: { x: { scale: "x", field: "x" },
          x2: { scale: "x", field: "x2" }, y: { scale: "n", field: "high" }, y2: { scale: "n", value: 0 },
          fill: { value: css("--mark") }, fillOpacity: { value: 0.15 },
          tooltip: { signal: `datum.n + ' people' + (datum.low < datum.high ? ' (' + datum.low + ' to ' + datum.high + ')' : '') + ', ' + ${moment("datum.x")} + ' to ' + ${moment("datum.x2")} + '${unit}'` } } } },
        { type: "rect", from: { data: "phases" }, encode: { enter: { x: { scale: "x", field: "from_s" },
          x2: { scale: "x", field: "to_s" }, y: { value: 0 }, y2: { signal: "height" }, fill: { value: css("--mark") },
          fillOpacity: { value: 0.1 },
          tooltip: { signal: `datum.name + ', ' + ${moment("datum.from_s")} + ' to ' + ${moment("datum.to_s")} + '${unit}'` } } } },
        { type: "rect", from: { data: "seen" }, encode: { enter: {
          x: { scale: "x", signal: "datum.t - " + chart.window_s }, x2: { scale: "x", field: "t" },
          y: { scale: "y", field: "row" }, height: { scale: "y", band: 1 }, fill: { value: css("--text") },
          tooltip: { signal: text } } } },
      ],
    };
  }

  // Long texts beside or below a chart: how much room they need.
  const longest = (texts, least, most) => Math.min(most, Math.max(least, ...texts.map((t) => 6.6 * t.length)));
  const ink = (dark) => (dark ? "#ffffff" : "#1b1f24");

  // Numbers in coloured squares. Dark squares carry light ink; framed ones stand out.
  function grid(chart, width) {
    const named = longest(chart.rows, 20, 170), inner = width - named - 112;
    const dense = chart.columns.length > 8, step = dense ? 21 : 27;
    const squares = chart.cells.map((cell, i) => Object.assign({ row: chart.rows[Math.floor(i / chart.columns.length)],
      column: chart.columns[i % chart.columns.length] }, cell));
    const two = chart.colours === "about_zero";
    squares.forEach((cell) => {
      const share = cell.v === null ? 0 : Math.abs(cell.v) / chart.max;
      cell.ink = cell.v === null ? css("--faint") : ink(share > (two ? 0.75 : 0.55));
      cell.tip = cell.row + ", " + cell.column + (cell.hint ? "\n" + cell.hint : "");
    });
    const box = { x: { scale: "x", field: "column" }, y: { scale: "y", field: "row" },
      width: { scale: "x", band: 1 }, height: { scale: "y", band: 1 } };
    return {
      width: inner, height: step * chart.rows.length, padding: 4,
      data: [{ name: "squares", values: squares.filter((cell) => cell.v !== null) },
        { name: "texts", values: squares.filter((cell) => cell.text) },
        { name: "framed", values: squares.filter((cell) => cell.framed) }],
      scales: [
        { name: "x", type: "band", domain: chart.columns, range: "width", padding: 0.04 },
        { name: "y", type: "band", domain: chart.rows, range: "height", padding: 0.04 },
        { name: "colour", type: "linear", clamp: true, zero: false,
          domain: two ? [-chart.max, chart.max] : [0, 0.25, 0.5, 0.75, 1].map((share) => share * chart.max),
          range: two ? { scheme: "blueorange" } : ["#f7fbff", "#c6dbef", "#6baed6", "#2171b5", "#08306b"] },
      ],
      axes: [axis("x", "top", chart.column_label || null, dense ? { labelAngle: -60, labelAlign: "left", ticks: false,
        domain: false, labelOverlap: false, labelLimit: 150 } : { ticks: false, domain: false }),
        axis("y", "left", chart.row_label || null, { ticks: false, domain: false, labelLimit: 170, labelOverlap: false })],
      legends: [{ fill: "colour", title: chart.label, type: "gradient", gradientLength: Math.min(step * chart.rows.length, 200),
        labelColor: css("--text"), titleColor: css("--text"), titleFontWeight: "normal", titleLimit: 104 }],
      marks: [
        { type: "rect", from: { data: "squares" }, encode: { enter: Object.assign({
          fill: { scale: "colour", field: "v" }, tooltip: { field: "tip" } }, box) } },
        { type: "rect", from: { data: "framed" }, interactive: false, encode: { enter: Object.assign({
          stroke: { value: css("--text") }, strokeWidth: { value: 2.5 } }, box) } },
        { type: "text", from: { data: "texts" }, interactive: false, encode: { enter: {
          x: { scale: "x", field: "column", band: 0.5 }, y: { scale: "y", field: "row", band: 0.5 },
          text: { field: "text" }, align: { value: "center" }, baseline: { value: "middle" }, fill: { field: "ink" },
          fontSize: { value: dense ? 10 : 12 }, fontWeight: { signal: "datum.framed ? 'bold' : 'normal'" } } } },
      ],
    };
  }

  // The band is the same for all points, so that being outside can be seen at a glance.
  function band(chart, width) {
    const named = longest(chart.rows.map((row) => row.name), 60, Math.min(330, 0.5 * width)), inner = width - named - 34;
    const points = chart.rows.flatMap((row) => row.points.map((p) => Object.assign({ row: row.name,
      x: Math.max(-chart.limit, Math.min(chart.limit, p.at)), far: Math.abs(p.at) > chart.limit }, p)));
    points.sort((a, b) => a.outside - b.outside);
    const words = [{ x: -chart.limit, text: "\u2190 " + chart.low, align: "left" },
      { x: 0, text: "the model", align: "center" }, { x: chart.limit, text: chart.high + " \u2192", align: "right" }];
    const height = 21 * chart.rows.length;
    return {
      width: inner, height, padding: { left: 4, right: 10, top: 22, bottom: 4 },
      data: [{ name: "points", values: points }, { name: "words", values: words }],
      scales: [
        { name: "x", type: "linear", domain: [-chart.limit, chart.limit], range: "width", nice: false, zero: false },
        { name: "y", type: "point", domain: chart.rows.map((row) => row.name), range: "height", padding: 0.6 },
      ],
      axes: [axis("x", "bottom", chart.label, { values: [-4, -3, -2, -1, 0, 1, 2, 3, 4] }),
        axis("y", "left", null, { ticks: false, domain: false, grid: true, gridColor: css("--rule"), labelLimit: named,
          labelPadding: 9, labelOverlap: false })],
      marks: [
        { type: "rect", interactive: false, encode: { enter: { x: { scale: "x", value: -1 }, x2: { scale: "x", value: 1 },
          y: { value: 0 }, y2: { signal: "height" }, fill: { value: css("--bar") }, fillOpacity: { value: 0.32 } } } },
        { type: "text", from: { data: "words" }, interactive: false, encode: { enter: { x: { scale: "x", field: "x" },
          y: { value: -8 }, text: { field: "text" }, align: { field: "align" }, fill: { value: css("--faint") },
          fontSize: { value: 12 } } } },
        { type: "symbol", from: { data: "points" }, encode: { enter: { x: { scale: "x", field: "x" },
          y: { scale: "y", field: "row" }, size: { signal: "datum.outside ? 75 : 34" },
          shape: { signal: "datum.far ? (datum.at > 0 ? 'triangle-right' : 'triangle-left') : 'circle'" },
          fill: { signal: "datum.outside ? '" + css("--real") + "' : '" + css("--text") + "'" },
          fillOpacity: { signal: "datum.outside ? 0.9 : 0.45" }, tooltip: { field: "hint" } } } },
      ],
    };
  }

  function bars(chart, width) {
    const named = longest(chart.bars.map((bar) => bar.name), 40, 0.45 * width);
    const after = longest(chart.bars.map((bar) => bar.text), 10, 0.3 * width), inner = width - named - after - 20;
    const most = Math.max(1e-9, ...chart.bars.map((bar) => Math.max(bar.v, bar.high === null ? 0 : bar.high)));
    const least = Math.min(0, ...chart.bars.map((bar) => Math.min(bar.v, bar.low === null ? 0 : bar.low)));
    const bars = chart.bars.map((bar) => Object.assign({}, bar, { tip: bar.name + "\n" + (bar.hint || bar.text),
      end: Math.max(bar.v, bar.high === null ? bar.v : bar.high, 0),
      colour: bar.weight === "strong" ? css("--mark") : css("--bar"), opacity: bar.weight === "faint" ? 0.45 : 1 }));
    return {
      width: inner, height: 24 * bars.length, padding: { left: 4, right: after, top: 4, bottom: 4 },
      data: [{ name: "bars", values: bars }, { name: "ranges", values: bars.filter((bar) => bar.low !== null) }],
      scales: [
        { name: "x", type: "linear", domain: [least, most], range: "width", nice: false, zero: true },
        { name: "y", type: "band", domain: bars.map((bar) => bar.name), range: "height", padding: 0.22 },
      ],
      axes: [axis("x", "bottom", chart.label, { tickCount: 5 }),
        axis("y", "left", null, { ticks: false, labelLimit: named, labelOverlap: false })],
      marks: [
        { type: "rect", from: { data: "bars" }, encode: { enter: { x: { scale: "x", value: least }, x2: { scale: "x", value: most },
          y: { scale: "y", field: "name" }, height: { scale: "y", band: 1 }, fill: { value: "#000000" }, fillOpacity: { value: 0 },
          tooltip: { field: "tip" } } } },
        { type: "rect", from: { data: "bars" }, interactive: false, encode: { enter: { x: { scale: "x", value: 0 },
          x2: { scale: "x", field: "v" }, y: { scale: "y", field: "name" }, height: { scale: "y", band: 1 },
          fill: { field: "colour" }, fillOpacity: { field: "opacity" } } } },
        { type: "rule", from: { data: "ranges" }, interactive: false, encode: { enter: { x: { scale: "x", field: "low" },
          x2: { scale: "x", field: "high" }, y: { scale: "y", field: "name", band: 0.5 }, stroke: { value: css("--text") },
          strokeWidth: { value: 2 } } } },
        { type: "text", from: { data: "bars" }, interactive: false, encode: { enter: { x: { scale: "x", field: "end", offset: 6 },
          y: { scale: "y", field: "name", band: 0.5 }, text: { field: "text" }, baseline: { value: "middle" },
          fill: { value: css("--text") }, fontSize: { value: 11 },
          fontWeight: { signal: "datum.weight === 'strong' ? 'bold' : 'normal'" } } } },
      ],
    };
  }

  // Each dot stands for the same probability; dots that would overlap are stacked.
  function dots(chart, width) {
    const inner = width - 30, size = Math.max(8, Math.min(15, inner / 32));
    const flat = (v) => (chart.log ? Math.log(v) : v), [from, to] = chart.axis.map(flat), n = Math.floor(inner / size);
    const heights = {}, points = chart.values.map((v) => {
      const bin = Math.max(0, Math.min(n - 1, Math.floor((flat(v) - from) / (to - from) * n)));
      heights[bin] = (heights[bin] || 0) + 1;
      return { x: (bin + 0.5) * inner / n, level: heights[bin], v };
    });
    const tallest = Math.max(3, ...Object.values(heights)), height = size * (tallest + 1.6);
    const inside = chart.reference !== null && chart.reference >= chart.axis[0] && chart.reference <= chart.axis[1];
    const tip = "'1 of " + chart.values.length + " equally likely values: ' + format(datum.v, '.3') + ' " + chart.label + "'";
    const marks = [
      { type: "rect", encode: { enter: { x: { scale: "x", value: chart.low }, x2: { scale: "x", value: chart.high },
        y: { value: 0 }, y2: { signal: "height" }, fill: { value: css("--mark") }, fillOpacity: { value: 0.14 },
        tooltip: { value: "90 %: " + Number(chart.low.toPrecision(3)) + " to " + Number(chart.high.toPrecision(3)) } } } },
      { type: "symbol", from: { data: "points" }, encode: { enter: { x: { field: "x" },
        y: { signal: "height - (datum.level - 0.5) * " + size }, size: { value: 0.62 * size * size },
        fill: { value: css("--mark") }, tooltip: { signal: tip } } } },
    ];
    if (inside) {
      const right = flat(chart.reference) > 0.5 * (from + to);
      marks.push({ type: "rule", interactive: false, encode: { enter: { x: { scale: "x", value: chart.reference },
        y: { value: 0 }, y2: { signal: "height" }, stroke: { value: css("--real") }, strokeWidth: { value: 2 },
        strokeDash: { value: [5, 3] } } } });
      marks.push({ type: "text", interactive: false, encode: { enter: { x: { scale: "x", value: chart.reference, offset: right ? -5 : 5 },
        y: { value: 11 }, text: { value: chart.reference_label }, align: { value: right ? "right" : "left" },
        fill: { value: css("--real") }, fontSize: { value: 11 } } } });
    }
    return {
      width: inner, height, padding: { left: 8, right: 12, top: 4, bottom: 4 }, data: [{ name: "points", values: points }],
      scales: [{ name: "x", type: chart.log ? "log" : "linear", domain: chart.axis, range: "width", nice: false, zero: false }],
      axes: [axis("x", "bottom", chart.label, { tickCount: 6, format: "~r" })], marks,
    };
  }

  // An axis in hours of a day, also beyond midnight.
  function hours([from, to], width) {
    const step = [0.25, 0.5, 1, 2, 3, 4, 6].find((one) => one / (to - from) * width >= 40) || 12, values = [];
    for (let hour = Math.ceil(from / step) * step; hour <= to + 1e-9; hour += step) values.push(hour);
    return { values, encode: { labels: { update: {
      text: { signal: "format(floor(datum.value) % 24, '02') + ':' + format(round(60 * (datum.value % 1)), '02')" } } } } };
  }

  function lines(chart, width) {
    const small = width < 340, inner = width - 62, height = Math.min(300, Math.round((small ? 0.5 : 0.6) * inner));
    const points = chart.points.map((p) => Object.assign({ tip: (chart.names.length > 1 ? p.line + "\n" : "") + (p.hint || p.y) }, p));
    const colour = { scale: "colour", field: "line" }, at = { x: { scale: "x", field: "x" } };
    const marks = [];
    if (chart.diagonal) {
      marks.push({ type: "rule", interactive: false, encode: { enter: { x: { scale: "x", value: chart.x[0] },
        x2: { scale: "x", value: chart.x[1] }, y: { scale: "y", value: chart.y[0] }, y2: { scale: "y", value: chart.y[1] },
        stroke: { value: css("--faint") }, strokeDash: { value: [5, 4] } } } });
    }
    marks.push({ type: "group", interactive: false, from: { facet: { name: "one line", data: "points", groupby: "line" } },
      marks: [{ type: "line", interactive: false, from: { data: "one line" }, encode: { enter: Object.assign({
        y: { scale: "y", field: "y" }, stroke: colour, strokeWidth: { value: 2 } }, at) } }] });
    marks.push({ type: "rule", interactive: false, from: { data: "ranges" }, encode: { enter: Object.assign({
      y: { scale: "y", field: "low" }, y2: { scale: "y", field: "high" }, stroke: colour, strokeWidth: { value: 1.5 },
      strokeOpacity: { value: 0.6 } }, at) } });
    marks.push({ type: "symbol", from: { data: "points" }, encode: { enter: Object.assign({ y: { scale: "y", field: "y" },
      size: { value: points.length > 60 ? 9 : 60 }, fill: colour, tooltip: { field: "tip" } }, at) } });
    const names = chart.x_names.length > 0, ticks = chart.x_names.map((name, i) => i + 1);
    return {
      width: inner, height, padding: 4,
      data: [{ name: "points", values: points }, { name: "ranges", values: points.filter((p) => p.low !== null) }],
      scales: [
        { name: "x", type: "linear", domain: chart.x, range: "width", nice: false, zero: false },
        { name: "y", type: "linear", domain: chart.y, range: "height", nice: false, zero: false },
        { name: "colour", type: "ordinal", domain: chart.names, range: chart.names.map((name, i) => css("--series-" + (i % 10 + 1))) },
      ],
      axes: [axis("x", "bottom", chart.x_label || null, names ? { values: ticks, encode: { labels: { update: {
        text: { signal: JSON.stringify(chart.x_names) + "[datum.value - 1]" } } } } } : chart.clock ? hours(chart.x, inner)
        : { tickCount: 5 }),
        axis("y", "left", chart.y_label || null, { tickCount: small ? 3 : 5 })],
      legends: chart.names.length > 1 ? [{ fill: "colour", orient: "bottom", symbolType: "circle", labelColor: css("--text"),
        labelLimit: inner, columns: small ? 1 : 2 }] : [],
      marks,
    };
  }

  // Days below each other. Light where there was some motion, dark where much; hatched where nothing is known.
  function days(chart, width) {
    const lines = chart.days.flatMap((day) => day.lines.map((line, i) => Object.assign({ day: i === 0 ? day.name : "", of: day.name }, line)));
    const dates = longest(chart.days.map((day) => day.name + "  "), 0, 120);
    const named = longest(lines.map((line) => line.name), 0, 150), left = dates + named + 14, inner = width - left - 24;
    const many = lines.length > 120, high = many ? 7 : 14, gap = many || chart.days.every((day) => day.lines.length < 2) ? 1 : 9;
    const most = Math.max(1, ...lines.filter((line) => line.people).flatMap((line) => line.runs.filter((v, i) => i % 3 === 2)));
    const seen = [], hatches = [], labels = [], toX = (bin) => bin / chart.n * inner;
    const two = (n) => String(n).padStart(2, "0");
    const moment = (bin) => {
      const s = chart.from + bin * chart.bin;
      if (!chart.clock) return s + " s";
      return two(Math.floor(s / 3600)) + ":" + two(Math.floor(s / 60) % 60) + (chart.bin < 60 ? ":" + two(Math.floor(s) % 60) : "");
    };
    const share = ["", "up to 5 %", "up to 20 %", "up to 50 %", "more than half"];
    let y = 0;
    lines.forEach((line) => {
      if (line.day && y > 0) y += gap;
      if (line.day) labels.push({ x: -left, y: y + high / 2, text: line.day, align: "left", bold: true });
      if (!many) labels.push({ x: -6, y: y + high / 2, text: line.name, align: "right" });
      for (let i = 0; i < line.runs.length; i += 3) {
        const [from, to, level] = line.runs.slice(i, i + 3), x = toX(from), x2 = toX(to);
        const what = level < 0 ? "unknown" : line.people ? level + (level === 1 ? " person" : " people") : "motion in " + share[level] + " of the time";
        seen.push({ x, x2, y, y2: y + high, colour: level < 0 ? "--rule" : line.people ? "--mark" : "--text",
          opacity: level < 0 ? 0.35 : line.people ? 0.2 + 0.8 * level / most : 0.25 + 0.1875 * level,
          tip: line.name + ", " + line.of + ", " + moment(from) + " to " + moment(to) + ": " + what });
        if (level < 0) hatches.push(hatched(x, x2, y, high));
      }
      y += high + 1;
    });
    const end = chart.from + chart.n * chart.bin, ticks = [];
    const step = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800].find((one) => one / (end - chart.from) * inner >= 48) || 14400;
    for (let s = Math.ceil(chart.from / step) * step; s <= end; s += step) ticks.push(s);
    const clock = { values: ticks, encode: { labels: { update: { text: { signal:
      `utcFormat(1000 * (datum.value % 86400), '${step < 60 ? "%H:%M:%S" : "%H:%M"}')` } } } } };
    const label = (where) => ({ type: "text", interactive: false, from: { data: "labels" }, encode: { enter: {
      x: { field: "x" }, y: { field: "y" }, text: { field: "text" }, align: { field: "align" }, baseline: { value: "middle" },
      fontSize: { value: many ? 8 : 11 }, fontWeight: { signal: "datum.bold ? 'bold' : 'normal'" }, fill: { value: css(where) },
      limit: { value: 150 } } } });
    return {
      width: inner, height: y, padding: { left: left + 4, right: 24, top: 4, bottom: 34 }, autosize: "none",
      data: [{ name: "seen", values: seen.map((one) => Object.assign(one, { colour: css(one.colour) })) },
        { name: "hatches", values: hatches.map((d) => ({ d })) }, { name: "labels", values: labels }],
      scales: [{ name: "x", type: "linear", domain: [chart.from, end], range: "width", nice: false, zero: false }],
      axes: [axis("x", "bottom", chart.clock ? null : "time, s", chart.clock ? clock : { tickCount: 8 })],
      marks: [
        { type: "rect", from: { data: "seen" }, encode: { enter: { x: { field: "x" }, x2: { field: "x2" }, y: { field: "y" },
          y2: { field: "y2" }, fill: { field: "colour" }, fillOpacity: { field: "opacity" }, tooltip: { field: "tip" } } } },
        { type: "path", interactive: false, from: { data: "hatches" }, encode: { enter: { path: { field: "d" },
          stroke: { value: css("--faint") }, strokeWidth: { value: 0.6 }, strokeOpacity: { value: 0.6 } } } },
        label("--text"),
      ],
    };
  }
  // Lines that rise through a box, as an SVG path.
  function hatched(x, x2, y, high) {
    let d = "";
    for (let from = Math.ceil((x - high) / 7) * 7; from < x2; from += 7) {
      const a = Math.max(from, x), b = Math.min(from + high, x2);
      if (b > a) d += `M${a.toFixed(1)},${(y + high - (a - from)).toFixed(1)}L${b.toFixed(1)},${(y + high - (b - from)).toFixed(1)}`;
    }
    return d;
  }

  function showTip(handler, event, item, value) {
    if (value === null || value === undefined || value === "") { tip.style.visibility = "hidden"; return; }
    tip.textContent = value;
    tip.style.visibility = "visible";
    const left = Math.min(event.clientX + 14, window.innerWidth - tip.offsetWidth - 6);
    tip.style.left = Math.max(4, left) + "px";
    tip.style.top = Math.max(4, event.clientY - tip.offsetHeight - 10) + "px";
  }

  const makers = { map, histogram, series, grid, band, bars, dots, lines, days }, views = new Map();
  function draw(place) {
    const chart = charts[Number(place.dataset.chart)];
    const width = Math.floor(place.clientWidth) - 8;
    if (width < 60) return;
    if (views.has(place)) views.get(place).finalize();
    const spec = Object.assign({ background: null, config: { text: { font: "system-ui, sans-serif" } } }, makers[chart.kind](chart, width));
    const view = new vega.View(vega.parse(spec), { renderer: "canvas", container: place, hover: false });
    view.tooltip(showTip).initialize(place);
    views.set(place, view);
    place.view = view;  // to look into it from a browser's console
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
