// The room in 3D: its solids, people who move, sensors, beams, a coverage map and names. Drawn with three.js.
"use strict";

class Room {
  /// shown: the moment, key, row and sensor that the page shows; choose: is told the index of a sensor that is clicked.
  constructor(run, shown, choose, renderer, gltf) {
    this.run = run;
    this.shown = shown;
    this.choose = choose;
    this.renderer = renderer;
    this.scene = new three.Scene();
    this.lights = [[new three.HemisphereLight("#ffffff", "#c9c2b8"), 2.2], [new three.DirectionalLight("#ffffff"), 1.3]];
    this.lights[1][0].position.set(2, 5, 3);
    this.scene.add(gltf.scene, ...this.lights.map(([light]) => light));
    this.painted = [];  // materials and the names of their colours
    this.camera = new three.PerspectiveCamera(40, 1, 0.05, 500);
    this.controls = new three.OrbitControls(this.camera, renderer.domElement);
    this.controls.addEventListener("change", () => (this.stale = true));
    this.controls.addEventListener("start", () => (this.turned = true));
    this.furnish(gltf.scene);
    this.hangSensors();
    this.makeLitBeams();
    this.drawAreas();
    if (this.run.map) this.layMap();
    this.makeLabels();
    this.animate(gltf);
    this.recolour();
    this.resize();
  }

  /// Room, people and beams get the materials of this page.
  furnish(root) {
    this.box = new three.Box3();
    this.heads = [];
    this.beams = this.run.sensors.map(() => null);
    const solids = [];
    root.updateMatrixWorld(true);
    root.traverse((node) => {
      const about = node.userData.pirsim;
      if (about && about.type === "beams") {
        this.beams[this.run.sensors.findIndex((sensor) => sensor.id === about.sensor)] = node;
        node.material = new three.LineBasicMaterial({ color: colour("beam"), transparent: true, opacity: 0.15 });
        node.visible = false;
      } else if (about && about.type === "body_part") {
        node.material = new three.MeshLambertMaterial({ color: node.material.color.clone() });
        node.frustumCulled = false;
        if (about.part === "head") {
          this.heads.push({ node, id: about.person, colour: node.material.color.clone() });
          node.material.color.lerp(new three.Color("#f1d0b5"), 0.75);
        }
      } else if (about && about.type === "leaf") {
        node.material = new three.MeshLambertMaterial({ color: node.material.color.clone() });
      } else if (node.isMesh) {
        solids.push(node);
        this.box.expandByObject(node);
      }
    });
    const centre = this.box.getCenter(new three.Vector3());
    for (const mesh of solids) this.paint(mesh, centre);
    for (const { position } of this.run.sensors) this.box.expandByPoint(new three.Vector3(...position));
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
      flatShading: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    if (!wall) mesh.material.side = three.DoubleSide;
    const edges = new three.EdgesGeometry(mesh.geometry, 20);
    const material = new three.LineBasicMaterial({ transparent: true, opacity: wall ? 0.25 : 0.5 });
    this.painted.push([mesh.material, white ? "wall" : flat ? "floor" : "furniture"], [material, "edge"]);
    mesh.add(new three.LineSegments(edges, material));
  }

  hangSensors() {
    this.markers = this.run.sensors.map((sensor) => {
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
    plumb.setAttribute("position", new three.BufferAttribute(new Float32Array(this.run.sensors.flatMap(
      ({ position: [x, y, z] }) => [x, y, z, x, this.box.min.y, z])), 3));
    this.scene.add(new three.LineSegments(plumb, new three.LineBasicMaterial(
      { color: colour("idle"), transparent: true, opacity: 0.6 })));
  }

  makeLitBeams() {
    // For each zone: its sensor and which of the sensor's lines are its beams.
    this.zones = [];
    let total = 0;
    this.run.sensors.forEach((sensor, i) => {
      let begin = 0;
      sensor.zone_rays.forEach((count, k) => {
        this.zones[sensor.first_zone + k] = { sensor: i, begin, count };
        begin += count;
        total += count;
      });
    });
    this.lit = new three.LineSegments(new three.BufferGeometry(), new three.LineBasicMaterial(
      { color: colour("lit"), transparent: true, opacity: 0.3 }));
    this.lit.geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(6 * total), 3));
    this.lit.frustumCulled = false;
    this.scene.add(this.lit);
  }

  /// The borders of areas on the floor.
  drawAreas() {
    const ends = this.run.areas.flatMap(({ loops, position: [, y] }) => loops.flatMap((loop) => loop.flatMap(
      ([x, z], i) => { const [x2, z2] = loop[(i + 1) % loop.length]; return [x, y + 0.012, z, x2, y + 0.012, z2]; })));
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(ends), 3));
    const material = new three.LineBasicMaterial();
    this.painted.push([material, "area"]);
    this.scene.add(new three.LineSegments(geometry, material));
    byId("bordered").hidden = this.run.areas.length === 0;
  }

  /// A coverage map as squares on the floor; showSensors() gives them their colours.
  layMap() {
    const { x, z, height_m: y, spacing_m: side, n_columns: columns, percent } = this.run.map;
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
    const { percent } = this.run.map, colours = this.map.geometry.getAttribute("color");
    const shareAt = this.shown.sensor >= 0 ? (i) => percent[this.shown.sensor][i]
                                           : (i) => Math.max(...percent.map((of) => of[i]));
    this.squares.forEach((square, i) => {
      const { r, g, b } = shareColour(shareAt(square) / 100);
      for (let corner = 0; corner < 4; ++corner) colours.setXYZ(4 * i + corner, r, g, b);
    });
    colours.needsUpdate = true;
    byId("whose").textContent = this.shown.sensor >= 0 ? `Here: what ${this.run.sensors[this.shown.sensor].id} sees.`
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
    this.buttons = [];  // of the sensors
    // The earlier ones keep their places where there isn't room for all.
    this.run.sensors.forEach((sensor, i) => {
      const { element } = add("sensor", sensor.id, sensor.position, "button");
      element.type = "button";
      element.addEventListener("click", () => this.choose(i));
      this.buttons.push(element);
    });
    const { areas, seats, doors } = this.run;
    for (const area of areas) add("area", area.name, area.position);
    for (const array of this.run.arrays || []) add("seat", array.id, array.position);
    for (const seat of seats) add("seat", seat.name, seat.position);
    for (const door of doors) add("door", /door/.test(door.name) ? door.name : "door " + door.name, door.position);
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

  /// Parts of the stage that the legend leaves free, in pixels: beside it and below it. Names at the edge need a margin.
  freeParts() {
    const { clientWidth: width, clientHeight: height } = byId("stage"), legend = byId("legend");
    const right = legend.offsetLeft + legend.offsetWidth, below = legend.offsetTop + legend.offsetHeight;
    const part = (left, top) => ({ left: left + 26, top: top + 26, right: width - 26, bottom: height - 16 });
    return [part(right - 10, 0), part(0, below - 10)].filter((it) => it.right > it.left && it.bottom > it.top);
  }

  /// Where the camera stands that sees the whole scene from above and beside, as large as it fits into a part of the
  /// stage whose middle is the middle of the view. A point p is seen at the slope (p - c) / (d - p_back), where c and d
  /// are the camera's place across and back; so c + slope d >= p + slope p_back, and c - slope d <= p - slope p_back.
  cameraFor(part) {
    const { min, max } = this.box, corners = [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) =>
      [min.z, max.z].map((z) => new three.Vector3(x, y, z))));
    const back = new three.Vector3(0.28, 0.95, 1).normalize();
    const right = new three.Vector3(0, 1, 0).cross(back).normalize(), up = back.clone().cross(right);
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360) / byId("stage").clientHeight;  // of half a pixel
    const position = new three.Vector3();
    let away = 0;
    for (const [axis, pixels] of [[right, part.right - part.left], [up, part.bottom - part.top]]) {
      const slope = pixels * tangent;
      const least = Math.max(...corners.map((p) => p.dot(axis) + slope * p.dot(back)));
      const most = Math.min(...corners.map((p) => p.dot(axis) - slope * p.dot(back)));
      away = Math.max(away, (least - most) / (2 * slope));
      position.addScaledVector(axis, (least + most) / 2);
    }
    position.addScaledVector(back, away);
    const depth = away - this.box.getCenter(new three.Vector3()).dot(back);
    return { part, away, position, target: position.clone().addScaledVector(back, -depth) };
  }

  /// The whole scene stays in view until the user turns it.
  resize() {
    const { clientWidth: width, clientHeight: height } = byId("stage");
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    const views = this.freeParts().map((part) => this.cameraFor(part)).sort((a, b) => a.away - b.away);
    const { part, away, position, target } = views[0] || this.cameraFor({ left: 0, top: 0, right: width, bottom: height });
    this.camera.far = Math.max(500, 4 * away);
    this.camera.setViewOffset(width, height, (width - part.left - part.right) / 2, (height - part.top - part.bottom) / 2,
                              width, height);
    if (!this.turned) {
      this.camera.position.copy(position);
      this.controls.target.copy(target);
      this.controls.update();
    }
    this.stale = true;
  }

  /// After the page's colours have changed.
  recolour() {
    this.renderer.setClearColor(colour("stage"));
    for (const [light, strength] of this.lights) light.intensity = strength * Number(colour("light"));
    for (const [material, name] of this.painted) material.color.set(colour(name));
    this.stale = true;
  }

  showTime() {
    if (this.end > 0) this.mixer.setTime(Math.min(this.shown.time, this.end - 1e-4));
    this.stale = true;
  }

  showZones() {
    const target = this.lit.geometry.getAttribute("position");
    let n = 0;
    for (const index of this.run.active_zones[this.shown.key]) {
      const zone = this.zones[index];
      if (this.shown.sensor >= 0 && zone.sensor !== this.shown.sensor) continue;
      const lines = this.beams[zone.sensor].geometry.getAttribute("position").array;
      target.array.set(lines.subarray(6 * zone.begin, 6 * (zone.begin + zone.count)), n);
      n += 6 * zone.count;
    }
    target.needsUpdate = true;
    this.lit.geometry.setDrawRange(0, n / 3);
    this.stale = true;
  }

  showSensors() {
    this.beams.forEach((beams, i) => beams && (beams.visible = i === this.shown.sensor));
    this.markers.forEach((marker, i) =>
      marker.material.color.set(colour(this.run.bit(this.shown.row, i) ? "fired" : "idle")));
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
      const wanted = y - above * label.high, top = freeTop(placed, x, wanted, label);
      // Far from its seat a name would tell of another one; who comes nearer sees it again.
      if (/area|seat|door/.test(element.className) && Math.abs(top - wanted) > 2.2 * label.high) {
        element.style.display = "none";
        continue;
      }
      const box = { x, wide: label.wide, high: label.high, top };
      placed.push(box);
      element.style.transform = `translate(${x.toFixed(1)}px, ${box.top.toFixed(1)}px) translate(-50%, 0)`;
    }
  }

  draw() {
    if (!this.stale) return;
    this.stale = false;
    this.renderer.render(this.scene, this.camera);
    this.placeLabels();
    document.body.dataset.drawn = this.shown.time;  // the moment that the picture shows
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

const shareColours = ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"].map((code) => new three.Color(code));
/// Of a share from 0 to 1: the scale of the key.
function shareColour(share) {
  const n = shareColours.length - 1, at = Math.min(Math.max(share, 0), 1) * n, lower = Math.min(Math.floor(at), n - 1);
  return shareColours[lower].clone().lerp(shareColours[lower + 1], at - lower);
}

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
