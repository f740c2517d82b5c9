// People and sensors' bits, and signals where there are any, second by second under the room.
"use strict";

class TimeLine {
  static heights = { people: 46, area: 18, bits: 20, signal: 34, axis: 18 };

  /// choose: is told the index of the sensor whose button is clicked.
  constructor(run, choose) {
    this.run = run;
    this.buttons = [];
    this.makeGutter(choose);
  }

  makeGutter(choose) {
    const people = document.createElement("div");
    people.className = "people";
    people.textContent = "people";
    people.style.height = TimeLine.heights.people + "px";
    byId("gutter").append(people);
    for (const name of this.run.counted) {
      const area = document.createElement("div");
      area.className = "area";
      area.textContent = area.title = name;
      area.style.height = TimeLine.heights.area + "px";
      byId("gutter").append(area);
    }
    this.run.sensors.forEach((sensor, i) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = sensor.id;
      button.title = sensor.model + ": show only its beams";
      button.style.height = this.heightOf(sensor) + "px";
      button.addEventListener("click", () => choose(i));
      byId("gutter").append(button);
      this.buttons.push(button);
    });
  }

  heightOf(sensor) {
    return TimeLine.heights.bits + (sensor.signal_v.length ? TimeLine.heights.signal : 0);
  }

  draw() {
    const canvas = byId("rows"), width = canvas.parentElement.clientWidth, scale = window.devicePixelRatio || 1;
    const { sensors, counted, from_s: from, to_s: to } = this.run, { heights } = TimeLine;
    const height = sensors.reduce((sum, sensor) => sum + this.heightOf(sensor),
                                  heights.people + heights.area * counted.length + heights.axis);
    canvas.width = width * scale;
    canvas.height = height * scale;
    canvas.style.height = height + "px";
    const pen = canvas.getContext("2d");
    pen.scale(scale, scale);
    pen.font = "11px system-ui, sans-serif";
    const x = (time) => ((time - from) / (to - from)) * width;
    this.drawPeople(pen, x);
    let top = heights.people;
    counted.forEach((_, i) => {
      this.drawArea(pen, x, i, top);
      top += heights.area;
    });
    sensors.forEach((sensor, i) => {
      this.drawBits(pen, x, i, top, width);
      top += heights.bits;
      if (!sensor.signal_v.length) return;
      this.drawSignal(pen, x, sensor, top, width);
      top += heights.signal;
    });
    this.drawAxis(pen, x, top, width);
  }

  drawPeople(pen, x) {
    const { rows, window_s: span, from_s: from, to_s: to } = this.run;
    const most = rows.people.reduce((some, n) => Math.max(some, n), 1), base = TimeLine.heights.people - 4, unit = (base - 12) / most;
    const steps = new Path2D(), area = new Path2D();
    rows.people.forEach((n, i) => {
      steps.lineTo(x(rows.time_s[i] - span), base - n * unit);
      steps.lineTo(x(rows.time_s[i]), base - n * unit);
    });
    area.addPath(steps);
    area.lineTo(x(to), base);
    area.lineTo(x(from), base);
    pen.fillStyle = colour("people");
    pen.globalAlpha = 0.25;
    pen.fill(area);
    pen.globalAlpha = 1;
    pen.strokeStyle = colour("people");
    pen.lineWidth = 1.5;
    pen.stroke(steps);
    pen.fillStyle = colour("people");
    for (let i = 0, end; i < rows.people.length; i = end) {  // the number where it changes, if there is room
      const n = rows.people[i], left = x(rows.time_s[i]);
      for (end = i + 1; rows.people[end] === n;) ++end;
      if (x(rows.time_s[end - 1]) - left > 14) pen.fillText(n, left + 2, base - n * unit - 3);
    }
  }

  /// How many people are in it: a number and a bar, none where nobody is.
  drawArea(pen, x, area, top) {
    const { rows, window_s: span } = this.run, high = TimeLine.heights.area - 4;
    const count = (row) => rows.people_of_areas[row][area];
    for (let i = 0, end; i < rows.time_s.length; i = end) {
      const n = count(i), left = x(rows.time_s[i] - span);
      for (end = i + 1; end < rows.time_s.length && count(end) === n;) ++end;
      if (n === 0) continue;
      const wide = Math.max(1, x(rows.time_s[end - 1]) - left);
      pen.fillStyle = colour("area");
      pen.globalAlpha = 0.25;
      pen.fillRect(left, top + 2, wide, high);
      pen.globalAlpha = 1;
      if (wide > 12) pen.fillText(n, left + 3, top + high - 1);
    }
  }

  drawBits(pen, x, sensor, top, width) {
    const { rows, window_s: span, from_s: from } = this.run, high = TimeLine.heights.bits - 4;
    pen.fillStyle = colour("row");
    pen.fillRect(0, top + 2, width, high);
    pen.fillStyle = colour("fired");
    rows.time_s.forEach((time, i) => {
      if (!this.run.bit(i, sensor)) return;
      const left = x(time - span);
      pen.fillRect(left, top + 2, Math.max(1, x(time) - left - (x(span + from) > 4 ? 1 : 0)), high);
    });
  }

  drawSignal(pen, x, sensor, top, width) {
    const { signal_v: signal, positive_v: up, negative_v: down } = sensor;
    // Not Math.max(...signal): hours of a signal are more arguments than a call takes.
    const most = signal.reduce((some, volts) => Math.max(some, Math.abs(volts)), 2 * Math.max(up, down));
    const middle = top + TimeLine.heights.signal / 2;
    const y = (volts) => middle - (volts / most) * (TimeLine.heights.signal / 2 - 2);
    pen.lineWidth = 1;
    pen.strokeStyle = colour("threshold");
    pen.setLineDash([3, 3]);
    for (const volts of [up, -down]) {
      pen.beginPath();
      pen.moveTo(0, y(volts));
      pen.lineTo(width, y(volts));
      pen.stroke();
    }
    pen.setLineDash([]);
    pen.strokeStyle = colour("text");
    pen.beginPath();
    signal.forEach((volts, i) => pen.lineTo(x(this.run.keys_s[i]), y(volts)));
    pen.stroke();
  }

  drawAxis(pen, x, top, width) {
    const { rows, from_s: from, to_s: to } = this.run, shift = this.run.clockBegin() % 86400;
    const step = stepBetween(to - from, width), marks = [];
    pen.fillStyle = colour("faint");
    // Where the clock stands at whole steps, not where the run's seconds do.
    for (let at = Math.ceil((from + shift) / step) * step; at <= to + shift; at += step) {
      const time = at - shift;
      pen.fillRect(x(time), top, 1, 4);
      const text = rows.first_clock && step % 60 === 0 ? this.run.clockText(time).slice(11, 16) : this.run.momentText(time);
      marks.push(text);
      const room = pen.measureText(text).width;
      pen.fillText(text, Math.min(Math.max(0, x(time) - room / 2), width - room), top + 15);
    }
    byId("rows").setAttribute("aria-label", "People and sensors' bits, from mark to mark: " + marks.join(", "));
  }
}

/// Between two marks of the axis, so that their texts have room.
function stepBetween(span, width) {
  const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200];
  return steps.find((step) => (step / span) * width >= 70) || 14400;
}

/// What a thermal array reads at a moment, from the coldest of the run to its warmest.
class FrameView {
  constructor(array, place) {
    this.array = array;
    this.pixels = Uint8Array.from(atob(array.bytes), (c) => c.charCodeAt(0));
    const figure = document.createElement("figure"), caption = document.createElement("figcaption");
    this.canvas = document.createElement("canvas");
    this.caption = caption;
    Object.assign(this.canvas, { width: array.columns, height: array.rows });
    this.canvas.setAttribute("aria-label", `Frame of ${array.id} (${array.model})`);
    figure.append(this.canvas, caption);
    place.append(figure);
  }

  show(key) {
    const { rows, columns, at_key: atKey, lowest_c: lowest, step_k: step, id } = this.array, n = rows * columns;
    const frame = this.pixels.subarray(n * atKey[key], n * (atKey[key] + 1));
    const pen = this.canvas.getContext("2d"), image = pen.createImageData(columns, rows);
    frame.forEach((byte, i) => {
      const share = (byte - 1) / 254, dead = byte === 0;  // black, red, yellow, white
      image.data.set(dead ? [128, 128, 128, 255] : [3, 3, 3].map((times, k) => 255 * Math.min(1, Math.max(0, times * share - k))).concat(255), 4 * i);
    });
    pen.putImageData(image, 0, 0);
    const celsius = (byte) => (lowest + (byte - 1) * step).toFixed(1), alive = frame.filter((byte) => byte > 0);
    this.caption.textContent = `${id}: ${celsius(Math.min(...alive))} to ${celsius(Math.max(...alive))} °C`;
  }
}
