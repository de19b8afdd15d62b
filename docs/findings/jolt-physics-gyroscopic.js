// /// finding
// engine = "jolt-physics"
// integrator = "step"
// setup = "as-shipped"
// scenario = "docs/findings/brick.toml"
// timestep = 0.01
// metric = "invariants/angular_momentum/drift_full"
// kind = "default"
// reach = "ordinary"
// title = "The gyroscopic term is off"
// what = "A brick that nothing touches keeps the direction of its omega, so that its angular momentum turns with it; a T-handle never flips."
// why = "mApplyGyroscopicForce is false. Damping takes a tenth of omega besides."
// mends = "mApplyGyroscopicForce = true; mAngularDamping = 0"
// link = "https://github.com/jrouwe/JoltPhysics/issues/803"
// ///
'use strict';
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

const [root] = require.resolve.paths('jolt-physics').filter((one) => fs.existsSync(path.join(one, 'jolt-physics')));
const folder = path.join(root, 'jolt-physics');
const about = JSON.parse(fs.readFileSync(path.join(folder, 'package.json')));

const [MOMENTS, RADIUS] = [[1, 2, 2.5], 1];
// The matrix of a quaternion (x, y, z, w), by rows.
const matrix = (x, y, z, w) => [
  [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
  [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
  [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
];
// R I R^T omega, in world axes.
function momentum(turn, omega) {
  const r = matrix(...turn);
  const own = MOMENTS.map((moment, j) => moment * (r[0][j] * omega[0] + r[1][j] * omega[1] + r[2][j] * omega[2]));
  return r.map((row) => row[0] * own[0] + row[1] * own[1] + row[2] * own[2]);
}
// How far the angular momentum drifts in 2 s, in parts of itself.
function drift(step, state) {
  const first = momentum(...state());
  let worst = 0;
  for (let n = 1; n <= 200; n += 1) {
    step(0.01);
    if (n % 2) continue;
    const gap = momentum(...state()).map((x, i) => x - first[i]);
    worst = Math.max(worst, Math.hypot(...gap) / Math.hypot(...first));
  }
  return worst;
}

function make(api, mass, moments, v, omega, mended) {
  const layers = new api.BroadPhaseLayerInterfaceTable(1, 1);
  layers.MapObjectToBroadPhaseLayer(0, new api.BroadPhaseLayer(0));
  const settings = new api.JoltSettings();
  settings.mObjectLayerPairFilter = new api.ObjectLayerPairFilterTable(1);
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new api.ObjectVsBroadPhaseLayerFilterTable(layers, 1, settings.mObjectLayerPairFilter, 1);
  const jolt = new api.JoltInterface(settings);
  jolt.GetPhysicsSystem().SetGravity(new api.Vec3(0, 0, 0));
  const bodies = jolt.GetPhysicsSystem().GetBodyInterface();
  const shape = new api.SphereShape(RADIUS);
  const own = new api.BodyCreationSettings(shape, new api.RVec3(0, 0, 0), new api.Quat(0, 0, 0, 1), api.EMotionType_Dynamic, 0);
  own.mOverrideMassProperties = api.EOverrideMassProperties_MassAndInertiaProvided;
  const inertia = api.Mat44.prototype.sIdentity();
  moments.forEach((moment, i) => inertia.SetColumn3(i, new api.Vec3(...[0, 1, 2].map((j) => (i === j ? moment : 0)))));
  own.mMassPropertiesOverride.mMass = mass;
  own.mMassPropertiesOverride.mInertia = inertia;
  Object.assign(own, mended);
  const body = bodies.CreateBody(own);
  bodies.AddBody(body.GetID(), api.EActivation_Activate);
  bodies.SetLinearAndAngularVelocity(body.GetID(), new api.Vec3(...v), new api.Vec3(...omega));
  return [jolt, body];
}
const list = (vector) => [vector.GetX(), vector.GetY(), vector.GetZ()];

import(pathToFileURL(path.join(folder, about.main))).then(({ default: start }) => start()).then((api) => {
  const brick = (mended) => {
    const [jolt, body] = make(api, 1, MOMENTS, [0, 0, 0], [1, 2, 3], mended);
    const state = () => [[...list(body.GetRotation()), body.GetRotation().GetW()], list(body.GetAngularVelocity())];
    return drift((h) => jolt.Step(h, 1), state);
  };
  console.log('release', about.version);
  console.log('figure', brick({}));
  console.log('mended', brick({ mApplyGyroscopicForce: true, mAngularDamping: 0 }));
});
