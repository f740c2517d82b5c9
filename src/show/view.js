// The page of `pirsim view`: plays one run, and shows a moment of it in the room, on the time line and in words.
"use strict";

(async function () {
  function tell(text) {
    byId("notice").textContent = text;
    byId("notice").hidden = !text;
  }

  if (typeof DecompressionStream === "undefined") {
    tell("This browser is too old for this page: it can't unpack gzip (DecompressionStream).");
    return;
  }
  const run = new Run(JSON.parse(new TextDecoder().decode(await unpacked("data"))));
  const { sensors, rows, from_s: fromS, to_s: toS } = run;

  // What is shown: a moment, and of which sensor.
  const shown = { time: fromS, playing: false, sensor: -1, key: -1, row: -1 };

  /// Null where the browser has no WebGL.
  async function makeRoom() {
    const canvas = byId("view");
    let renderer;
    const complain = console.error;
    try {
      console.error = () => {};  // three.js says the same again
      renderer = new three.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    } catch (fault) {
      tell("The room can't be drawn: this browser has no WebGL, or it is switched off. The time line works without it.");
      return null;
    } finally {
      console.error = complain;
    }
    const bytes = await unpacked("glb");
    const gltf = await new Promise((done, fail) => new three.GLTFLoader().parse(bytes, "", done, fail));
    return new Room(run, shown, choose, renderer, gltf);
  }

  // On a narrow page an open legend would leave no place for the room.
  const narrow = window.matchMedia("(max-width: 700px)");
  const foldLegend = () => (byId("legend").open = !narrow.matches);

  let room = null;
  const timeLine = new TimeLine(run, choose);
  const frames = (run.arrays || []).map((array) => new FrameView(array, byId("frames")));
  /// Of each sensor.
  const buttons = () => sensors.map((_, i) => [timeLine.buttons[i], ...(room ? [room.buttons[i]] : [])]);

  function showTime() {
    const key = run.keyAt(shown.time), row = run.rowAt(shown.time);
    byId("time").value = shown.time;
    byId("cursor").style.left = ((shown.time - fromS) / (toS - fromS)) * 100 + "%";
    const seconds = rows.first_clock ? "" : "  (" + shown.time.toFixed(1) + " s)";
    byId("clock").textContent = run.clockText(shown.time) + seconds;
    if (room) room.showTime();
    if (key !== shown.key) {
      shown.key = key;
      frames.forEach((frame) => frame.show(key));
      if (room) room.showZones();
    }
    if (row === shown.row) return;
    shown.row = row;
    const n = rows.people[row];
    const who = run.first_person ? run.first_person + ": " : "";
    const end = run.momentText(rows.time_s[row]);
    const where = run.counted.flatMap((area, i) => rows.people_of_areas[row][i] ? [`${area} ${rows.people_of_areas[row][i]}`] : []);
    byId("now").textContent = `row ${end}: ${who}${rows.phase[row]}, ${n} ${n === 1 ? "person" : "people"}` +
      (where.length ? ` (${where.join(", ")})` : "");
    buttons().forEach((all, i) => all.forEach((button) => button.classList.toggle("on", run.bit(row, i))));
    document.body.dataset.row = [rows.time_s[row], rows.phase[row], n, ...rows.bits[row]].join(",");
    if (room) room.showSensors();
  }

  function goTo(time) {
    shown.time = Math.min(toS, Math.max(fromS, time));
    showTime();
  }

  /// As goTo(), and the page's address leads back here.
  function jumpTo(time) {
    tell("");
    goTo(time);
    const sensor = shown.sensor >= 0 ? "&sensor=" + encodeURIComponent(sensors[shown.sensor].id) : "";
    history.replaceState(null, "", "#t=" + Number(shown.time.toFixed(2)) + sensor);
  }

  function choose(sensor) {
    shown.sensor = sensor === shown.sensor ? -1 : sensor;
    buttons().forEach((all, i) => all.forEach((button) => {
      button.classList.toggle("chosen", i === shown.sensor);
      button.classList.toggle("dimmed", shown.sensor >= 0 && i !== shown.sensor);
    }));
    byId("all").hidden = shown.sensor < 0;
    if (!room) return;
    room.showZones();
    room.showSensors();
    room.showMap();
  }

  function play(playing) {
    if (playing && shown.time >= toS) goTo(fromS);
    shown.playing = playing;
    byId("play").textContent = playing ? "Pause" : "Play";
    tell("");
  }

  /// "#t=123&sensor=PIR4", "#phase=working"
  function followAddress() {
    const asked = new URLSearchParams(location.hash.slice(1));
    const sensor = sensors.findIndex(({ id }) => id === asked.get("sensor"));
    if (sensor >= 0 && sensor !== shown.sensor) choose(sensor);
    const first = rows.phase.indexOf(asked.get("phase"));
    if (first >= 0) goTo(rows.time_s[first]);
    if (!asked.has("t")) return;
    const time = Number(asked.get("t"));
    goTo(time);
    const here = time >= fromS && time <= toS;
    tell(here ? "" : `${run.momentText(time)} isn't on this page: it holds ${run.momentText(fromS)} to ` +
      `${run.momentText(toS)} of a run that ends at ${run.momentText(run.run_s)}. ` +
      "pirsim view --from and --to choose another part.");
  }

  function onKey(event) {
    if (event.target.tagName === "SELECT" || event.ctrlKey || event.altKey || event.metaKey) return;
    const step = (event.shiftKey ? 10 : 1) * run.window_s;
    const actions = {
      " ": () => play(!shown.playing),
      ArrowRight: () => jumpTo(rows.time_s[shown.row] + step),
      ArrowLeft: () => jumpTo(rows.time_s[shown.row] - step),
      Home: () => jumpTo(fromS),
      End: () => jumpTo(toS),
      Escape: () => shown.sensor >= 0 && choose(shown.sensor),
    };
    if (!(event.key in actions)) return;
    event.preventDefault();
    actions[event.key]();
  }

  function listen() {
    byId("play").addEventListener("click", () => play(!shown.playing));
    byId("all").addEventListener("click", () => shown.sensor >= 0 && choose(shown.sensor));
    byId("names").addEventListener("change", (event) => (byId("labels").hidden = !event.target.checked));
    byId("map").addEventListener("change", () => room && room.showMap());
    byId("time").addEventListener("input", (event) => jumpTo(Number(event.target.value)));
    byId("rows").addEventListener("click", (event) => {
      const box = byId("rows").getBoundingClientRect();
      jumpTo(rows.time_s[run.rowAt(fromS + ((event.clientX - box.left) / box.width) * (toS - fromS))]);
    });
    document.addEventListener("keydown", onKey);
    // A focused button would take the space bar for itself.
    document.addEventListener("keyup", (event) => event.key === " " && event.preventDefault());
    window.addEventListener("hashchange", followAddress);
    byId("legend").addEventListener("toggle", () => room && room.resize());
    narrow.addEventListener("change", foldLegend);
    window.addEventListener("resize", () => {
      timeLine.draw();
      if (room) room.resize();
    });
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
      timeLine.draw();
      if (!room) return;
      room.recolour();
      room.showSensors();
    });
  }

  let last = null;
  function frame(now) {
    if (shown.playing && last !== null) {
      goTo(shown.time + ((now - last) / 1000) * Number(byId("speed").value));
      if (shown.time >= toS) play(false);
    }
    last = now;
    if (room) room.draw();
    requestAnimationFrame(frame);
  }

  Object.assign(byId("time"), { min: fromS, max: toS, step: "any" });
  foldLegend();
  timeLine.draw();
  room = await makeRoom();
  listen();
  showTime();
  followAddress();
  if (room) room.showMap();
  if (room) room.draw();
  requestAnimationFrame(frame);
  document.body.dataset.ready = room ? "room" : "rows";
})();
