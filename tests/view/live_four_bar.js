// A kernel in closed form for the four-bar of page_data.py: cranks, couplers, rockers and grounds of any length.
(() => {
  const { data } = window.mechkin;
  const [own] = data.runs[0].branches;
  const ROWS = own.rows;
  const f64 = (text) => new Float64Array(Uint8Array.from(atob(text), (each) => each.charCodeAt(0)).buffer);
  const degrees = f64(own.x.f64);
  const parameters = [
    { name: "a", unit: "mm", value: 30, text: "30 mm", low: 15, high: 60 },
    { name: "b", unit: "mm", value: 80, text: "80", low: 40, high: 160 },
    { name: "c", unit: "mm", value: 60, text: "6 cm", low: 30, high: 120 },
    { name: "d", unit: "mm", value: 90, text: "90 mm", low: 45, high: 180 },
  ];
  function placesAt({ a, b, c, d }, theta) {
    const crank = [a * Math.cos(theta), a * Math.sin(theta)];
    const [dx, dy] = [d - crank[0], -crank[1]];
    const length = Math.hypot(dx, dy);
    const cosine = (b * b + length * length - c * c) / (2 * b * length);
    if (!(Math.abs(cosine) <= 1)) return null;
    const phi = Math.atan2(dy, dx) + Math.acos(cosine);
    const along = [Math.cos(phi), Math.sin(phi)];
    const rocker = [crank[0] + b * along[0], crank[1] + b * along[1]];
    const tip = [crank[0] + b * (0.4 * along[0] - 0.5 * along[1]), crank[1] + b * (0.4 * along[1] + 0.5 * along[0])];
    return { crank, rocker, tip, phi, psi: Math.atan2(rocker[1], rocker[0] - d) };
  }
  const about = (angle, [x, y], [nx, ny]) => {
    const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
    return [nx - cos * x + sin * y, ny - sin * x - cos * y, 0, Math.cos(angle / 2), 0, 0, Math.sin(angle / 2)];
  };
  const run = {
    parameters,
    fixed: [{ name: "n", why: "counts the teeth", command: "mechkin view four-bar.yaml --set n=20" }],
    computed: 0,
    compute(given) {
      run.computed += 1;
      const start = performance.now();
      const values = Object.fromEntries(parameters.map(({ name, value }) => [name, given[name] ?? value]));
      const home = placesAt(values, 0);
      const found = Array.from(degrees, (each) => placesAt(values, (each * Math.PI) / 180));
      if (!home || found.includes(null)) return { end: "lost", words: `no position at row ${found.indexOf(null) + 1}` };
      const poses = new Float32Array(ROWS * 4 * 7);
      const [psi, phi, tip] = [0, 0, 0].map(() => new Float64Array(ROWS));
      found.forEach((at, row) => {
        const theta = (degrees[row] * Math.PI) / 180;
        poses.set([0, 0, 0, 1, 0, 0, 0, ...about(theta, [0, 0], [0, 0]), ...about(at.phi - home.phi, home.crank, at.crank),
          ...about(at.psi - home.psi, [values.d, 0], [values.d, 0])], 28 * row);
        [psi[row], phi[row], tip[row]] = [(at.psi * 180) / Math.PI, (at.phi * 180) / Math.PI, at.tip[1]];
      });
      const columns = own.columns.map((column) => ({ ...column, values: { psi, phi, tip_y: tip }[column.label] }));
      const numbers = [degrees, psi, phi];
      const table = { ...data.tables[0], rows: null, count: ROWS, row: (k) => numbers.map((each) => each[k].toFixed(2)), columns: data.tables[0].columns.map((column, k) => ({ ...column, exact: numbers[k] })) };
      const solid = ([x, y]) => [x, y, 0];
      const points = { A: [0, 0], B: home.crank, C: home.rocker, D: [values.d, 0] };
      const drawn = {
        joints: data.joints.map((joint) => ({ ...joint, halves: joint.halves.map((half) => ({ ...half, point: solid(points[joint.name]) })) })),
        points: data.points.map((point) => ({ ...point, place: solid(home.tip) })),
        links: data.links.map((link, k) => ({ ...link, shape: { ...link.shape, points: [[], ["A", "B"], ["B", "C"], ["C", "D"]][k].map((name) => solid(points[name])).concat(k === 2 ? [solid(home.tip)] : []) } })),
      };
      const branch = { ...own, columns, poses: { rows: Int32Array.from(degrees, (_, k) => k), values: poses } };
      return { end: "complete", branch, tables: [table], drawn, milliseconds: performance.now() - start };
    },
  };
  window.mechkin.run = run;
  window.mechkin.bring(run);
  return true;
})()
