// /// finding
// engine = "jolt-physics"
// integrator = "step"
// scenario = "sphere"
// setup = "as-shipped"
// timestep = 0.01
// metric = "trajectory/omega/error_max"
// kind = "default"
// reach = "ordinary"
// title = "Every body is damped"
// what = "A sphere that nothing touches loses a fifth of its omega in 5 s."
// why = "mLinearDamping and mAngularDamping are 0.05: velocities are multiplied by 1 - 0.05 h at each step."
// mends = "mLinearDamping = 0; mAngularDamping = 0"
// link = "https://github.com/jrouwe/JoltPhysics/blob/master/Jolt/Physics/Body/BodyCreationSettings.h"
// ///
'use strict';
const fs = require('fs');
const path = require('path');
const { pathToFileURL } = require('url');

const [root] = require.resolve.paths('jolt-physics').filter((one) => fs.existsSync(path.join(one, 'jolt-physics')));
const folder = path.join(root, 'jolt-physics');
const about = JSON.parse(fs.readFileSync(path.join(folder, 'package.json')));

const RADIUS = 0.1;
// How much of omega is lost in 5 s.
function lost(step, omega) {
  for (let n = 0; n < 500; n += 1) step(0.01);
  return Math.hypot(omega()[0] - 1, omega()[1] - 2, omega()[2] - 3) / Math.hypot(1, 2, 3);
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
  const sphere = (mended) => {
    const [jolt, body] = make(api, 1, [0.4, 0.4, 0.4], [0.5, -0.25, 0.125], [1, 2, 3], mended);
    return lost((h) => jolt.Step(h, 1), () => list(body.GetAngularVelocity()));
  };
  console.log('release', about.version);
  console.log('figure', sphere({}));
  console.log('mended', sphere({ mLinearDamping: 0, mAngularDamping: 0 }));
});
