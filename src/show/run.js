// What a page of `pirsim view` holds: one run, its keys, rows and sensors. Time is in seconds of the run everywhere.
"use strict";

const byId = (id) => document.getElementById(id);
/// Of the palette.
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();

/// The bytes that the page carries under this id.
async function unpacked(id) {
  const text = atob(byId(id).textContent);
  const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}

/// The last index whose value is not above `value`; 0 if there is none.
function lastUpTo(values, value) {
  let low = 0, high = values.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (values[middle] <= value + 1e-6) low = middle; else high = middle - 1;
  }
  return low;
}

class Run {
  constructor(data) {
    Object.assign(this, data);
    this.from_s = data.keys_s[0];
    this.to_s = data.keys_s[data.keys_s.length - 1];
  }

  keyAt(time) {
    return lastUpTo(this.keys_s, time);
  }

  /// A row tells of the window that ends at its time: at 12.3 s it is that of second 13.
  rowAt(time) {
    const row = lastUpTo(this.rows.time_s, time);
    return row + 1 < this.rows.time_s.length && this.rows.time_s[row] < time - 1e-6 ? row + 1 : row;
  }

  bit(row, sensor) {
    return this.rows.bits[row][sensor] === "1";
  }

  /// What the clock says at the run's second 0, in seconds since 1970; 0 if the rows have no clock.
  clockBegin() {
    const { rows } = this;
    // The clock is cut off to whole seconds, and a run begins at one.
    return rows.first_clock ? Math.ceil(Date.parse(rows.first_clock + "Z") / 1000 - rows.time_s[0] - 1e-6) : 0;
  }

  /// A moment as the rows tell it: by the clock if they have one, or in seconds.
  momentText(time) {
    return this.rows.first_clock ? this.clockText(time).slice(11) : time + " s";
  }

  clockText(time) {
    const two = (n) => String(Math.floor(n)).padStart(2, "0"), { rows } = this;
    let seconds = time, day = "";
    if (rows.first_clock) {
      const begin = this.clockBegin();
      const date = new Date((begin + time) * 1000);
      day = date.toISOString().slice(0, 10) + " ";
      seconds = (begin + time) % 86400;
    }
    const hours = seconds >= 3600 || day ? two(seconds / 3600) + ":" : "";
    return day + hours + two((seconds / 60) % 60) + ":" + two(seconds % 60);
  }
}
