// Serves one of the engines in this folder: node worker.js ENGINE FOLDER, with the folder of its
// package.
//
// ENGINE.js exports `open(folder)`, which gives the engine's API, and makes of it
//   description(api, setup, driven)    what docs/worker-protocol.md requires of `describe`, but for the
//                                      version; an integrator has one order in all channels, and
//                                      a scheme where the reference has it; driven: whether a
//                                      torque acts on the body that is loaded
//   refused(body)                      why it cannot take a body, or ''
//   World(api, setup, body, gravity)   a world with the body, anew for each run:
//     put(state), state()              a state is { q, w, p, v }, all in world axes, p and v of the
//                                      centre of mass
//     step(h, torque)                  one step, with a torque in world axes, null for none
//     model()                          mass, center_of_mass, inertia (flat), as the engine holds them
//     free()
'use strict';
console.log = console.info = console.error; // standard output is for answers alone

const fs = require('fs');
const path = require('path');
const { Table, Unsupported, receive, send } = require('./channel.js');
const { conjugate, rotated } = require('./rotations.js');

const CHANNELS = ['omega', 'attitude', 'energy', 'angular_momentum', 'linear_momentum', 'position'];
const KEYS = { orientation: 'q', angular_velocity: 'w', position: 'p', linear_velocity: 'v' };

class Server {
  constructor(engine, api, version) {
    [this.engine, this.api, this.version] = [engine, api, version];
  }

  describe({ setup }) {
    this.setup = setup;
    return this.described(false);
  }

  described(driven) {
    const { integrators, ...rest } = this.engine.description(this.api, this.setup, driven);
    this.known = { version: this.version, ...rest, integrators: integrators.map(withOrders) };
    return this.known;
  }

  load({ body, load }) {
    const { name } = this.known;
    if (load.pivot !== null) throw new Unsupported(`the adapter of ${name} has no pivoted bodies`);
    if (load.damping) {
      throw new Unsupported(`${name} has no damping torque d omega: its own damping slows every body alike, whatever its inertia`);
    }
    const reason = this.engine.refused(body);
    if (reason) throw new Unsupported(reason);
    [this.body, this.gravity] = [body, load.gravity];
    this.inBody = load.torque_body.some((x) => x !== 0) ? load.torque_body : null;
    this.inWorld = load.torque_world.some((x) => x !== 0) ? load.torque_world : null;
    this.world?.free();
    this.world = this.made();
    return this.described(Boolean(this.inBody || this.inWorld));
  }

  made() {
    return new this.engine.World(this.api, this.setup, this.body, this.gravity);
  }

  model() {
    const { mass, center_of_mass: center, inertia } = this.world.model();
    return { mass: new Table([], [mass]), center_of_mass: new Table([3], center), inertia: new Table([3, 3], inertia) };
  }

  set_state({ state }) {
    this.world.put(inWorld(state));
    return null;
  }

  get_state() {
    return tables([inProject(this.world.state())], []);
  }

  // The torque for the next step, in world axes: constant during the step.
  torque() {
    if (this.inBody === null) return this.inWorld;
    const turned = rotated(this.world.state().q, this.inBody);
    return this.inWorld ? turned.map((x, i) => x + this.inWorld[i]) : turned;
  }

  run({ initial, integrator, timestep, steps, every }) {
    if (!this.known.integrators.some(({ name }) => name === integrator)) {
      throw new Unsupported(`${this.known.name} has no integrator '${integrator}'`);
    }
    this.world.free(); // nothing is left of an earlier run
    this.world = this.made();
    const kept = [0];
    for (let step = every; step < steps; step += every) kept.push(step);
    if (steps > 0) kept.push(steps);
    const { rows, seconds } = this.stepped(inWorld(initial), timestep, kept);
    const time = new Table([kept.length], kept.map((step) => step * timestep));
    return { time, state: tables(rows.map(inProject), [rows.length]), seconds: new Table([], [seconds]) };
  }

  // States at these steps. A run that is no longer finite is not gone on with: its later rows are NaN.
  stepped(start, timestep, kept) {
    const rows = [start];
    const fits = isFinite_(start, this.known.precision === 'float32' ? Math.fround : Number);
    if (fits) {
      this.world.put(start);
      rows[0] = this.world.state();
    }
    const began = performance.now();
    for (let at = 1; fits && at < kept.length && isFinite_(rows[at - 1], Number); at++) {
      for (let step = kept[at - 1]; step < kept[at]; step++) this.world.step(timestep, this.torque());
      rows.push(this.world.state());
    }
    const seconds = (performance.now() - began) / 1e3;
    while (rows.length < kept.length) rows.push(NONE);
    return { rows, seconds };
  }
}

function withOrders({ name, scheme = null, order, note }) {
  const orders = Object.fromEntries(CHANNELS.map((channel) => [channel, order]));
  return { name, scheme, orders, note };
}

const NONE = { q: Array(4).fill(NaN), w: Array(3).fill(NaN), p: Array(3).fill(NaN), v: Array(3).fill(NaN) };
const isFinite_ = (state, rounded) => Object.values(state).flat().every((x) => Number.isFinite(rounded(x)));

function inWorld({ orientation: q, angular_velocity: w, position: p, linear_velocity: v }) {
  return { q, w: rotated(q, w), p, v };
}
const inProject = ({ q, w, p, v }) => ({ q, w: rotated(conjugate(q), w), p, v });

// The arrays of an answer, of states with leading axes `lead`.
function tables(states, lead) {
  const entries = Object.entries(KEYS).map(([key, short]) => {
    const flat = states.flatMap((state) => state[short]);
    return [key, new Table([...lead, flat.length / states.length], flat)];
  });
  return Object.fromEntries(entries);
}

const OPERATIONS = ['describe', 'load', 'model', 'set_state', 'get_state', 'run'];

function answer(server, request) {
  if (!OPERATIONS.includes(request.operation)) return { outcome: 'unsupported' };
  try {
    return { outcome: 'ok', result: server[request.operation](request) };
  } catch (error) {
    return { outcome: error instanceof Unsupported ? 'unsupported' : 'raised', reason: error.message ?? String(error) };
  }
}

async function main([name, folder]) {
  const engine = require(`./${name}.js`);
  const { version } = JSON.parse(fs.readFileSync(path.join(folder, 'package.json'), 'utf8'));
  const server = new Server(engine, await engine.open(folder), version);
  for (;;) send(answer(server, receive()));
}

main(process.argv.slice(2));
