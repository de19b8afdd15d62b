// Poinsot's ellipsoid in body axes, its columns in `ellipsoid`, and where each omega pierces it.
const axesOf = (ellipsoid) => [0, 1, 2].map((k) => [ellipsoid[k], ellipsoid[3 + k], ellipsoid[6 + k]]);
const onUnitBall = (axes, p) => axes.map((axis) => dot(axis, p) / dot(axis, axis));
const pierced = (axes, w) => times(w, 1 / (Math.hypot(...onUnitBall(axes, w)) || 1));

function polhodeOf(scenario, shown, theme) {
  const { scene, sun } = litScene(), axes = axesOf(scenario.ellipsoid), [a, b, c] = axes;
  const ball = new THREE.SphereGeometry(1, 2 * detail.sides, detail.sides).applyMatrix4(new THREE.Matrix4().makeBasis(vector(a), vector(b), vector(dot(cross(a, b), c) < 0 ? times(c, -1) : c)));
  scene.add(new THREE.Mesh(ball, surface({ color: theme.rule, shininess: 10 })));
  for (const [one, two] of [[a, b], [b, c], [c, a]]) scene.add(seenThrough(tube(ring((x, y) => plus(times(one, x), times(two, y))), 0.005, true), theme.soft));
  const runs = shown.map(({ trajectory, colour }, k) => {
    // The exact curve is the broadest and lies lowest, so that one that agrees with it is seen too.
    const exactOne = trajectory.line < 0, lift = 1 + 0.005 * k, line = tube(trajectory.w.map((w) => times(pierced(axes, w), lift)), 0.015 - 0.002 * k);
    const dot = seenThrough(new THREE.SphereGeometry(0.04, 16, 8), colour, 0.4);
    scene.add(seenThrough(line, colour), dot);
    return { trajectory, line, dot, exactOne };
  });
  // The exact curve stands whole; a run's grows with the clock.
  const set = (time) => {
    for (const { trajectory, line, dot, exactOne } of runs) {
      const passed = exactOne ? trajectory.w.length : trajectory.time.filter((t) => t <= time).length;
      line.setDrawRange(0, Math.max(0, passed - 1) * detail.tube * 6);
      dot.position.set(...pierced(axes, poseAt(trajectory, time).w));
    }
  };
  // The ends of the axes that the eye sees, a little beyond the surface.
  const ends = ({ to }) => axes.flatMap((axis, k) => [1, -1].map((side) => [times(axis, side * (1 + 0.12 / Math.hypot(...axis))), ["I₁", "I₂", "I₃"][k], side * facingOf(axes, axis, to)]))
    .filter(([, , facing]) => facing >= 0);
  return { scene, sun, set, ends };
}
const facingOf = (axes, axis, to) => dot(onUnitBall(axes, axis), onUnitBall(axes, to));
