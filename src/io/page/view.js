// Plays one run: the page's glTF holds room, people and beams; its data say which zones are active and what the rows
// are. Time is in seconds of the run everywhere.
"use strict";

(async function () {
  const byId = (id) => document.getElementById(id);

  function tell(text) {
    byId("notice").textContent = text;
    byId("notice").hidden = !text;
  }

  async function unpacked(id) {
    const text = atob(byId(id).textContent);
    const bytes = Uint8Array.from(text, (c) => c.charCodeAt(0));
    return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  }

  if (typeof DecompressionStream === "undefined") {
    tell("This browser is too old for this page: it can't unpack gzip (DecompressionStream).");
    return;
  }
  const data = JSON.parse(new TextDecoder().decode(await unpacked("data")));
  const { sensors, rows, keys_s: keys } = data;
  const fromS = keys[0], toS = keys[keys.length - 1];

  // What is shown: a moment, and of which sensor.
  const shown = { time: fromS, playing: false, sensor: -1, key: -1, row: -1 };

  // ---------------------------------------------------------------------------------------------------- rows and keys
  /// The last index whose value is not above `value`; 0 if there is none.
  function lastUpTo(values, value) {
    let low = 0, high = values.length - 1;
    while (low < high) {
      const middle = Math.ceil((low + high) / 2);
      if (values[middle] <= value + 1e-6) low = middle; else high = middle - 1;
    }
    return low;
  }
  /// A row tells of the window that ends at its time: at 12.3 s it is that of second 13.
  function rowAt(time) {
    const row = lastUpTo(rows.time_s, time);
    return row + 1 < rows.time_s.length && rows.time_s[row] < time - 1e-6 ? row + 1 : row;
  }
  const bit = (row, sensor) => rows.bits[row][sensor] === "1";

  function two(n) { return String(Math.floor(n)).padStart(2, "0"); }
  function clockText(time) {
    let seconds = time, day = "";
    if (rows.first_clock) {
      const begin = Date.parse(rows.first_clock + "Z") / 1000 - rows.time_s[0];
      const date = new Date((begin + time) * 1000);
      day = date.toISOString().slice(0, 10) + " ";
      seconds = (begin + time) % 86400;
    }
    const hours = seconds >= 3600 || day ? two(seconds / 3600) + ":" : "";
    return day + hours + two((seconds / 60) % 60) + ":" + two(seconds % 60);
  }

  // ------------------------------------------------------------------------------------------------------ the time line
  const heights = { people: 46, bits: 20, signal: 34, axis: 18 };
  const style = getComputedStyle(document.documentElement);
  const colour = (name) => style.getPropertyValue("--" + name).trim();

  const buttons = [];
  function makeGutter() {
    const people = document.createElement("div");
    people.className = "people";
    people.textContent = "people";
    people.style.height = heights.people + "px";
    byId("gutter").append(people);
    sensors.forEach((sensor, i) => {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = sensor.id;
      button.title = sensor.model + ": show only its beams";
      button.style.height = heights.bits + (sensor.signal_v.length ? heights.signal : 0) + "px";
      button.addEventListener("click", () => choose(i));
      byId("gutter").append(button);
      buttons.push([button]);
    });
  }

  function stepOf(span, width) {
    const steps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200];
    return steps.find((step) => (step / span) * width >= 70) || 14400;
  }

  function drawPeople(pen, x) {
    const most = Math.max(1, ...rows.people), base = heights.people - 4, unit = (base - 12) / most;
    const steps = new Path2D(), area = new Path2D();
    rows.people.forEach((n, i) => {
      steps.lineTo(x(rows.time_s[i] - data.window_s), base - n * unit);
      steps.lineTo(x(rows.time_s[i]), base - n * unit);
    });
    area.addPath(steps);
    area.lineTo(x(toS), base);
    area.lineTo(x(fromS), base);
    pen.fillStyle = colour("people");
    pen.globalAlpha = 0.25;
    pen.fill(area);
    pen.globalAlpha = 1;
    pen.strokeStyle = colour("people");
    pen.lineWidth = 1.5;
    pen.stroke(steps);
    pen.fillStyle = colour("people");
    rows.people.forEach((n, i) => {  // the number where it changes, if there is room
      const wide = rows.people.slice(i).findIndex((other) => other !== n);
      const end = wide < 0 ? rows.people.length : i + wide;
      const width = x(rows.time_s[end - 1]) - x(rows.time_s[i]);
      if ((i === 0 || rows.people[i - 1] !== n) && width > 14) pen.fillText(n, x(rows.time_s[i]) + 2, base - n * unit - 3);
    });
  }

  function drawBits(pen, x, sensor, top, width) {
    pen.fillStyle = "#e4e8ec";
    pen.fillRect(0, top + 2, width, heights.bits - 4);
    pen.fillStyle = colour("fired");
    rows.time_s.forEach((time, i) => {
      if (!bit(i, sensor)) return;
      const left = x(time - data.window_s);
      pen.fillRect(left, top + 2, Math.max(1, x(time) - left - (x(data.window_s + fromS) > 4 ? 1 : 0)), heights.bits - 4);
    });
  }

  function drawSignal(pen, x, sensor, top, width) {
    const { signal_v: signal, positive_v: up, negative_v: down } = sensor;
    const most = Math.max(2 * up, 2 * down, ...signal.map(Math.abs));
    const middle = top + heights.signal / 2;
    const y = (volts) => middle - (volts / most) * (heights.signal / 2 - 2);
    pen.lineWidth = 1;
    pen.strokeStyle = "#b0b8c1";
    pen.setLineDash([3, 3]);
    for (const volts of [up, -down]) {
      pen.beginPath();
      pen.moveTo(0, y(volts));
      pen.lineTo(width, y(volts));
      pen.stroke();
    }
    pen.setLineDash([]);
    pen.strokeStyle = "#24292f";
    pen.beginPath();
    signal.forEach((volts, i) => pen.lineTo(x(keys[i]), y(volts)));
    pen.stroke();
  }

  function drawAxis(pen, x, top, width) {
    pen.fillStyle = colour("faint");
    const step = stepOf(toS - fromS, width);
    for (let time = Math.ceil(fromS / step) * step; time <= toS; time += step) {
      pen.fillRect(x(time), top, 1, 4);
      const text = rows.first_clock ? clockText(time).slice(11) : time + " s";
      const room = pen.measureText(text).width;
      pen.fillText(text, Math.min(Math.max(0, x(time) - room / 2), width - room), top + 15);
    }
  }

  function drawRows() {
    const canvas = byId("rows"), width = canvas.parentElement.clientWidth, scale = window.devicePixelRatio || 1;
    let height = heights.people + heights.axis;
    for (const sensor of sensors) height += heights.bits + (sensor.signal_v.length ? heights.signal : 0);
    canvas.width = width * scale;
    canvas.height = height * scale;
    canvas.style.height = height + "px";
    const pen = canvas.getContext("2d");
    pen.scale(scale, scale);
    pen.font = "11px system-ui, sans-serif";
    const x = (time) => ((time - fromS) / (toS - fromS)) * width;
    drawPeople(pen, x);
    let top = heights.people;
    sensors.forEach((sensor, i) => {
      drawBits(pen, x, i, top, width);
      top += heights.bits;
      if (!sensor.signal_v.length) return;
      drawSignal(pen, x, sensor, top, width);
      top += heights.signal;
    });
    drawAxis(pen, x, top, width);
  }

  // ---------------------------------------------------------------------------------------------------------- the room
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
    renderer.setClearColor("#e9edf2");
    const bytes = await unpacked("glb");
    const gltf = await new Promise((done, fail) => new three.GLTFLoader().parse(bytes, "", done, fail));
    return new Room(renderer, gltf);
  }

  class Room {
    constructor(renderer, gltf) {
      this.renderer = renderer;
      this.scene = new three.Scene();
      this.scene.add(gltf.scene, new three.HemisphereLight("#ffffff", "#c9c2b8", 2.2));
      const sun = new three.DirectionalLight("#ffffff", 1.3);
      sun.position.set(2, 5, 3);
      this.scene.add(sun);
      this.camera = new three.PerspectiveCamera(40, 1, 0.05, 500);
      this.controls = new three.OrbitControls(this.camera, renderer.domElement);
      this.controls.addEventListener("change", () => (this.stale = true));
      this.furnish(gltf.scene);
      this.hangSensors();
      this.makeLitBeams();
      if (data.map) this.layMap();
      this.makeLabels();
      this.animate(gltf);
      this.resize();
      this.lookFromAbove();
    }

    /// Room, people and beams get the materials of this page.
    furnish(root) {
      this.box = new three.Box3();
      this.heads = [];
      this.beams = sensors.map(() => null);
      const solids = [];
      root.updateMatrixWorld(true);
      root.traverse((node) => {
        const about = node.userData.pirsim;
        if (about && about.type === "beams") {
          this.beams[sensors.findIndex((sensor) => sensor.id === about.sensor)] = node;
          node.material = new three.LineBasicMaterial({ color: colour("beam"), transparent: true, opacity: 0.35 });
          node.visible = false;
        } else if (about && about.type === "body_part") {
          node.material = new three.MeshLambertMaterial({ color: node.material.color.clone() });
          node.frustumCulled = false;
          if (about.part === "head") {
            this.heads.push({ node, id: about.person, colour: node.material.color.clone() });
            node.material.color.lerp(new three.Color("#f1d0b5"), 0.75);
          }
        } else if (node.isMesh) {
          solids.push(node);
          this.box.expandByObject(node);
        }
      });
      const centre = this.box.getCenter(new three.Vector3());
      for (const mesh of solids) this.paint(mesh, centre);
    }

    /// Walls and ceilings are seen from the inside alone, so that one looks into the room from any side. A wall is tall
    /// and thin or long; what is tall but neither, a cupboard or a column, is seen from all sides, as furniture is.
    paint(mesh, centre) {
      const box = new three.Box3().setFromObject(mesh), size = box.getSize(new three.Vector3());
      const room = this.box.getSize(new three.Vector3()), [thin, long] = [size.x, size.z].sort((a, b) => a - b);
      const tall = box.max.y > this.box.min.y + 1.8, flat = size.y < 0.02;
      const wall = tall && (thin < 0.22 || long > 0.35 * Math.max(room.x, room.z));
      const white = wall || box.max.y > this.box.max.y - 0.3;
      if (wall) faceTowards(mesh.geometry, centre);
      mesh.material = new three.MeshLambertMaterial({
        color: white ? "#f7f7f4" : flat ? "#d9d4cb" : "#b98f63", flatShading: true,
        polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
      });
      if (!wall) mesh.material.side = three.DoubleSide;
      const edges = new three.EdgesGeometry(mesh.geometry, 20);
      const material = new three.LineBasicMaterial({ color: "#57606a", transparent: true, opacity: wall ? 0.25 : 0.5 });
      mesh.add(new three.LineSegments(edges, material));
    }

    hangSensors() {
      this.markers = sensors.map((sensor) => {
        const marker = new three.Mesh(new three.ConeGeometry(0.09, 0.16, 20),
                                      new three.MeshLambertMaterial({ color: colour("idle") }));
        const forward = new three.Vector3(...sensor.forward);
        marker.quaternion.setFromUnitVectors(new three.Vector3(0, -1, 0), forward);  // the wide end looks
        marker.position.set(...sensor.position).addScaledVector(forward, 0.02);
        this.scene.add(marker);
        return marker;
      });
      // A plumb line from each sensor: on a wall that isn't drawn it would hang in the air, no one knows where.
      const plumb = new three.BufferGeometry();
      plumb.setAttribute("position", new three.BufferAttribute(new Float32Array(sensors.flatMap(
        ({ position: [x, y, z] }) => [x, y, z, x, this.box.min.y, z])), 3));
      this.scene.add(new three.LineSegments(plumb, new three.LineBasicMaterial(
        { color: colour("idle"), transparent: true, opacity: 0.6 })));
    }

    makeLitBeams() {
      // For each zone: its sensor and which of the sensor's lines are its beams.
      this.zones = [];
      let total = 0;
      sensors.forEach((sensor, i) => {
        let begin = 0;
        sensor.zone_rays.forEach((count, k) => {
          this.zones[sensor.first_zone + k] = { sensor: i, begin, count };
          begin += count;
          total += count;
        });
      });
      this.lit = new three.LineSegments(new three.BufferGeometry(), new three.LineBasicMaterial(
        { color: colour("lit"), transparent: true, opacity: 0.55 }));
      this.lit.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(6 * total), 3));
      this.lit.frustumCulled = false;
      this.scene.add(this.lit);
    }

    /// A coverage map as squares on the floor; showSensors() gives them their colours.
    layMap() {
      const { x, z, height_m: y, spacing_m: side, n_columns: columns, percent } = data.map;
      this.squares = [];
      percent[0].forEach((share, i) => share >= 0 && this.squares.push(i));
      const corners = new Float32Array(12 * this.squares.length), triangles = new Uint32Array(6 * this.squares.length);
      this.squares.forEach((square, i) => {
        const left = x + side * (square % columns), back = z + side * Math.floor(square / columns);
        for (const [k, [right, front]] of [[0, 0], [0, side], [side, side], [side, 0]].entries())
          corners.set([left + right, y + 0.004, back + front], 12 * i + 3 * k);
        triangles.set([0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner), 6 * i);
      });
      const geometry = new three.BufferGeometry();
      geometry.setAttribute("position", new three.BufferAttribute(corners, 3));
      geometry.setAttribute("color", new three.BufferAttribute(new Float32Array(corners.length), 3));
      geometry.setIndex(new three.BufferAttribute(triangles, 1));
      this.map = new three.Mesh(geometry, new three.MeshBasicMaterial(
        { vertexColors: true, transparent: true, opacity: 0.8 }));
      this.scene.add(this.map);
      byId("scale").hidden = byId("mapped").hidden = false;
    }

    colourMap() {
      const { percent } = data.map, colours = this.map.geometry.getAttribute("color");
      const shareAt = shown.sensor >= 0 ? (i) => percent[shown.sensor][i]
                                        : (i) => Math.max(...percent.map((of) => of[i]));
      this.squares.forEach((square, i) => {
        const { r, g, b } = shareColour(shareAt(square) / 100);
        for (let corner = 0; corner < 4; ++corner) colours.setXYZ(4 * i + corner, r, g, b);
      });
      colours.needsUpdate = true;
      byId("whose").textContent = shown.sensor >= 0 ? `Here: what ${sensors[shown.sensor].id} sees.`
                                                    : "Here: of the sensor that sees most.";
      this.map.visible = byId("map").checked;
    }

    makeLabels() {
      const add = (kind, text, position, tag = "span") => {
        const element = document.createElement(tag);
        element.className = kind;
        element.textContent = text;
        byId("labels").append(element);
        const label = { element, position: new three.Vector3(...position) };
        this.labels.push(label);
        return label;
      };
      this.labels = [];
      // The earlier ones keep their places where there isn't room for all.
      sensors.forEach((sensor, i) => {
        const { element } = add("sensor", sensor.id, sensor.position, "button");
        element.type = "button";
        element.addEventListener("click", () => choose(i));
        buttons[i].push(element);
      });
      for (const seat of data.seats) add("seat", seat.name, seat.position);
      for (const door of data.doors) add("door", /door/.test(door.name) ? door.name : "door " + door.name, door.position);
      for (const head of this.heads) {
        head.label = add("person", head.id, [0, 0, 0]);
        head.label.element.style.borderColor = head.colour.getStyle();
      }
    }

    animate(gltf) {
      this.mixer = new three.AnimationMixer(gltf.scene);
      this.end = 0;
      if (!gltf.animations.length) return;
      this.end = gltf.animations[0].duration;
      this.mixer.clipAction(gltf.animations[0]).play();
    }

    /// From so far that the whole room is seen.
    lookFromAbove() {
      const centre = this.box.getCenter(new three.Vector3()), { min, max } = this.box;
      const back = new three.Vector3(0.28, 0.95, 1).normalize();
      const right = new three.Vector3(0, 1, 0).cross(back).normalize(), up = back.clone().cross(right);
      const half = Math.tan((this.camera.fov * Math.PI) / 360), { clientWidth: width } = byId("stage");
      const axes = [[right, half * this.camera.aspect * (1 - this.covered() / width)], [up, half]];
      const corners = [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) =>
        [min.z, max.z].map((z) => new three.Vector3(x, y, z))));
      let away = 0;
      for (let round = 0; round < 4; ++round) {  // what is nearer looks larger, so its middle isn't the picture's
        const seen = corners.map((corner) => corner.clone().sub(centre));
        away = Math.max(...seen.map((corner) => corner.dot(back) + 1.06 * Math.max(
          ...axes.map(([axis, reach]) => Math.abs(corner.dot(axis)) / reach))));
        for (const [axis] of axes) {
          const slopes = seen.map((corner) => corner.dot(axis) / (away - corner.dot(back)));
          centre.addScaledVector(axis, away * (Math.max(...slopes) + Math.min(...slopes)) / 2);
        }
      }
      this.camera.position.copy(back).multiplyScalar(away).add(centre);
      this.controls.target.copy(centre);
      this.controls.update();
    }

    /// Pixels on the left that the legend takes, if the rest is wide enough for the room.
    covered() {
      const legend = byId("legend"), { clientWidth: width } = byId("stage");
      const right = legend.open ? legend.offsetLeft + legend.offsetWidth : 0;
      return right < 0.4 * width ? right : 0;
    }

    resize() {
      const { clientWidth: width, clientHeight: height } = byId("stage");
      this.renderer.setPixelRatio(window.devicePixelRatio || 1);
      this.renderer.setSize(width, height, false);
      this.camera.aspect = width / height;
      this.camera.setViewOffset(width, height, -this.covered() / 2, 0, width, height);
      this.stale = true;
    }

    showTime() {
      if (this.end > 0) this.mixer.setTime(Math.min(shown.time, this.end - 1e-4));
      this.stale = true;
    }

    showZones() {
      const target = this.lit.geometry.getAttribute("position");
      let n = 0;
      for (const index of data.active_zones[shown.key]) {
        const zone = this.zones[index];
        if (shown.sensor >= 0 && zone.sensor !== shown.sensor) continue;
        const lines = this.beams[zone.sensor].geometry.getAttribute("position").array;
        target.array.set(lines.subarray(6 * zone.begin, 6 * (zone.begin + zone.count)), n);
        n += 6 * zone.count;
      }
      target.needsUpdate = true;
      this.lit.geometry.setDrawRange(0, n / 3);
      this.stale = true;
    }

    showSensors() {
      this.beams.forEach((beams, i) => beams && (beams.visible = i === shown.sensor));
      this.markers.forEach((marker, i) => marker.material.color.set(colour(bit(shown.row, i) ? "fired" : "idle")));
      this.stale = true;
    }

    showMap() {
      if (!this.map) return;
      this.colourMap();
      this.stale = true;
    }

    placeLabels() {
      const { clientWidth: width, clientHeight: height } = byId("stage"), point = new three.Vector3();
      for (const head of this.heads) {
        head.node.getWorldPosition(head.label.position);
        head.label.position.y += 0.3;
        head.label.away = point.setFromMatrixColumn(head.node.matrixWorld, 0).length() < 0.5;  // its scale
      }
      const placed = [];
      for (const label of this.labels) {
        const { element, position, away } = label;
        point.copy(position).project(this.camera);
        const visible = !away && point.z < 1 && Math.abs(point.x) < 1.05 && Math.abs(point.y) < 1.05;
        element.style.display = visible ? "" : "none";
        if (!visible) continue;
        label.wide ||= element.offsetWidth;
        label.high ||= element.offsetHeight;
        const x = ((point.x + 1) / 2) * width, y = ((1 - point.y) / 2) * height;
        const above = element.className.startsWith("sensor") ? 1.5 : 0.5;  // times its height
        const box = { x, wide: label.wide, high: label.high, top: freeTop(placed, x, y - above * label.high, label) };
        placed.push(box);
        element.style.transform = `translate(${x.toFixed(1)}px, ${box.top.toFixed(1)}px) translate(-50%, 0)`;
      }
    }

    draw() {
      if (!this.stale) return;
      this.stale = false;
      this.renderer.render(this.scene, this.camera);
      this.placeLabels();
      document.body.dataset.drawn = shown.time;  // the moment that the picture shows
    }
  }

  /// Where a label covers no earlier one: where it should be, or just above or below those in its way. Where there is
  /// no room nearby it stays.
  function freeTop(placed, x, top, { wide, high }) {
    const near = placed.filter((box) => Math.abs(box.x - x) < (box.wide + wide) / 2);
    const free = (at) => near.every((box) => at + high <= box.top || at >= box.top + box.high);
    const places = near.flatMap((box) => [box.top - high, box.top + box.high]).concat(top).filter(free);
    const nearest = Math.min(...places.map((at) => Math.abs(at - top)));
    return nearest > 6 * high ? top : places.find((at) => Math.abs(at - top) === nearest);
  }

  /// Of a share from 0 to 1: the scale of the key.
  function shareColour(share) {
    const at = Math.min(Math.max(share, 0), 1) * (scale.length - 1), lower = Math.min(Math.floor(at), scale.length - 2);
    return scale[lower].clone().lerp(scale[lower + 1], at - lower);
  }
  const scale = ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"].map((code) => new three.Color(code));

  function faceTowards(geometry, centre) {
    const { array } = geometry.index, points = geometry.getAttribute("position");
    const [a, b, c, normal] = [0, 1, 2, 3].map(() => new three.Vector3());
    for (let i = 0; i < array.length; i += 3) {
      a.fromBufferAttribute(points, array[i]);
      b.fromBufferAttribute(points, array[i + 1]);
      c.fromBufferAttribute(points, array[i + 2]);
      normal.crossVectors(b.sub(a), c.sub(a));
      if (normal.dot(a.sub(centre)) > 0) [array[i + 1], array[i + 2]] = [array[i + 2], array[i + 1]];
    }
  }

  // ------------------------------------------------------------------------------------------------------- what is shown
  let room = null;

  function showTime() {
    const key = lastUpTo(keys, shown.time), row = rowAt(shown.time);
    byId("time").value = shown.time;
    byId("cursor").style.left = ((shown.time - fromS) / (toS - fromS)) * 100 + "%";
    byId("clock").textContent = clockText(shown.time) + (rows.first_clock ? "" : "  (" + shown.time.toFixed(1) + " s)");
    if (room) room.showTime();
    if (key !== shown.key) {
      shown.key = key;
      if (room) room.showZones();
    }
    if (row === shown.row) return;
    shown.row = row;
    const n = rows.people[row];
    const who = data.first_person ? data.first_person + ": " : "";
    const end = rows.first_clock ? clockText(rows.time_s[row]).slice(11) : rows.time_s[row] + " s";
    byId("now").textContent = `row ${end}: ${who}${rows.phase[row]}, ${n} ${n === 1 ? "person" : "people"}`;
    buttons.forEach((all, i) => all.forEach((button) => button.classList.toggle("on", bit(row, i))));
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
    buttons.forEach((all, i) => all.forEach((button) => {
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
    tell(here ? "" : `Second ${asked.get("t")} isn't on this page: it holds ${fromS} to ${toS} s of a run of ` +
      `${data.run_s} s. pirsim view --from and --to choose another part.`);
  }

  function onKey(event) {
    if (event.target.tagName === "SELECT" || event.ctrlKey || event.altKey || event.metaKey) return;
    const step = (event.shiftKey ? 10 : 1) * data.window_s;
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
      jumpTo(rows.time_s[rowAt(fromS + ((event.clientX - box.left) / box.width) * (toS - fromS))]);
    });
    document.addEventListener("keydown", onKey);
    // A focused button would take the space bar for itself.
    document.addEventListener("keyup", (event) => event.key === " " && event.preventDefault());
    window.addEventListener("hashchange", followAddress);
    byId("legend").addEventListener("toggle", () => room && room.resize());
    window.addEventListener("resize", () => {
      drawRows();
      if (room) room.resize();
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
  makeGutter();
  drawRows();
  room = await makeRoom();
  listen();
  showTime();
  followAddress();
  if (room) room.showMap();
  if (room) room.draw();
  requestAnimationFrame(frame);
  document.body.dataset.ready = room ? "room" : "rows";
})();
