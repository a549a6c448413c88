// Flies `whirl fly` with node-mavlink, a MAVLink library by other hands, then flies the recording again:
//   node fly.mjs WHIRL PACE FOLDER
// Asks what QGroundControl asks, sets a parameter, arms, takes off, goes to a place, lands, sees it disarm.
import { spawn, spawnSync } from 'node:child_process'
import { readFileSync, realpathSync } from 'node:fs'
import assert from 'node:assert/strict'
import { common, standard, minimal, MavLinkProtocolV1 } from 'node-mavlink'
import { Vehicle } from './vehicle.mjs'

const [program, pace, folder] = process.argv.slice(2)
const kArmed = 0x80, kAccepted = 0, kDenied = 2, kUnsupported = 3
const vehicle = new Vehicle()
const texts = []

function made(type, fields) { return Object.assign(new type(), fields) }
const to_vehicle = { targetSystem: 1, targetComponent: 1 }

async function start() {
  const port = await vehicle.listen()
  const flight = spawn(program, ['fly', '--udp', `127.0.0.1:${port}`, '--pace', pace, '--out', folder],
                       { stdio: ['ignore', 'pipe', 'inherit'] })
  let said = ''
  const ended = new Promise(resolve => flight.on('exit', (code, signal) => resolve(signal ?? code)))
  vehicle.talk_to(await new Promise((resolve, reject) => {
    flight.stdout.on('data', text => {
      said += text
      const own = said.match(/from any at port (\d+)/)
      if (own) resolve(Number(own[1]))
    })
    ended.then(how => reject(new Error(`whirl fly ended (${how}) before it flew: ${said}`)))
  }))
  return { flight, ended, said: () => said }
}

// What a ground station asks when it has heard a first heartbeat.
async function get_to_know() {
  const beat = await vehicle.next(minimal.Heartbeat)
  assert.equal(beat.type, 2, 'a quadrotor')
  assert.equal(beat.baseMode & kArmed, 0, 'it starts disarmed')
  const version = vehicle.next(standard.AutopilotVersion)
  assert.equal(await vehicle.command(512, { 1: 148 }), kAccepted)
  assert.equal(Number((await version).capabilities) & 8192, 8192, 'it speaks MAVLink 2')
  assert.equal(await vehicle.command(520, { 1: 1 }), kAccepted)
  assert.equal(await vehicle.command(512, { 1: 397 }), kDenied)
  assert.equal(await vehicle.command(511, { 1: 30, 2: 1e6 }), kUnsupported)
  await vehicle.send(made(common.RequestDataStream, { ...to_vehicle, reqMessageRate: 2, startStop: 1 }))
  const mission = await vehicle.ask(made(common.MissionRequestList, to_vehicle), common.MissionCount)
  assert.equal(mission.count, 0)
  const time = await vehicle.ask(made(common.TimeSync, { tc1: 0n, ts1: 12345n }), common.TimeSync)
  assert.equal(time.ts1, 12345n)
}

// By a list, then one by one what the list lost, as the protocol has it.
async function read_parameters() {
  const known = new Map()
  let count = Infinity
  vehicle.each((name, message) => {
    if (name !== 'ParamValue') return
    known.set(message.paramIndex, message.paramId)
    count = message.paramCount
  })
  await vehicle.ask(made(common.ParamRequestList, to_vehicle), common.ParamValue)
  await vehicle.next(common.ParamValue, () => known.size === count, 5).catch(() => {})
  for (let index = 0; index < count; ++index) {
    if (known.has(index)) continue
    await vehicle.ask(made(common.ParamRequestRead, { ...to_vehicle, paramIndex: index, paramId: '' }),
                      common.ParamValue, value => value.paramIndex === index)
  }
  assert.equal(known.size, count)
  assert.ok(known.size >= 5 && new Set(known.values()).size === known.size, 'each has a name of its own')
  return known
}

async function value_of(request, name) {
  return (await vehicle.ask(request, common.ParamValue, answer => answer.paramId === name)).paramValue
}

function asked_for(name) {
  return value_of(made(common.ParamRequestRead, { ...to_vehicle, paramIndex: -1, paramId: name }), name)
}

// What it is set to is what it holds, now and when it is asked later; `refused`: what it held before.
async function set_parameter(name, value, refused = false) {
  const before = await asked_for(name)
  assert.notEqual(before, value, `${name} is to change`)
  const set = made(common.ParamSet, { ...to_vehicle, paramId: name, paramValue: value, paramType: 9 })
  assert.equal(await value_of(set, name), refused ? before : value)
  assert.equal(await asked_for(name), refused ? before : value)
}

// Nothing of this may lose what comes behind it, nor do anything.
async function disturb() {
  const arm = made(common.CommandLong, { ...to_vehicle, command: 400, _param1: 1 })
  const frame = vehicle.bytes_of(arm)
  const wrong_crc = Buffer.from(frame), for_others = made(common.CommandLong, { ...arm, targetSystem: 7 })
  wrong_crc[frame.length - 1] ^= 0x40
  const garbage = Array.from({ length: 300 }, (_, i) => (i * 7919) & 0xFF)
  for (const bytes of [garbage, [0xFD, 0xFF, 0], Array(300).fill(0xFD), [], wrong_crc, vehicle.bytes_of(for_others),
                       new MavLinkProtocolV1(255, 190).serialize(arm, 0), Array(9000).fill(0xFD)]) {
    await vehicle.send_bytes(bytes)
    await vehicle.ask(made(common.MissionRequestList, to_vehicle), common.MissionCount)
  }
  const beat = await vehicle.next(minimal.Heartbeat)
  assert.equal(beat.baseMode & kArmed, 0, 'still disarmed')
}

async function arm() {
  for (let i = 0; i < 20; ++i) {
    if (await vehicle.command(400, { 1: 1 }) === kAccepted) return
    await vehicle.next(minimal.Heartbeat)  // not ready yet: a text says why
  }
  throw new Error(`it does not arm: ${texts.join('; ')}`)
}

// Streams the place until the vehicle is there.
async function go_to(x, y, z) {
  const there = vehicle.next(common.LocalPositionNed,
                             p => Math.hypot(p.x - x, p.y - y, p.z - z) < 0.1)
  const target = made(common.SetPositionTargetLocalNed, {
    ...to_vehicle, coordinateFrame: 1, typeMask: 0x09F8, x, y, z, yaw: 0, vx: 0, vy: 0, vz: 0, afx: 0, afy: 0, afz: 0
  })
  const stream = setInterval(() => vehicle.send(target), 200 / Number(pace))
  try { return await there } finally { clearInterval(stream) }
}

async function fly() {
  await arm()
  await vehicle.next(minimal.Heartbeat, beat => (beat.baseMode & kArmed) !== 0)
  await set_parameter('EST_FILTER', 0, true)  // not while armed
  assert.equal(await vehicle.command(22, { 7: 99 }), kDenied, 'higher than it may')
  assert.equal(await vehicle.command(22, { 7: 1.1 }), kAccepted)
  await vehicle.next(common.LocalPositionNed, p => p.z < -1.0)
  await go_to(0.8, -0.5, -1.3)
  const landed = vehicle.next(common.StatusText, text => text.text === 'landed')
  assert.equal(await vehicle.command(21), kAccepted)
  await vehicle.next(minimal.Heartbeat, beat => (beat.baseMode & kArmed) === 0)
  await landed  // a heartbeat may come before it
}

function run_json(path) { return JSON.parse(readFileSync(path + '/run.json', 'utf8')) }

async function main() {
  const { flight, ended, said } = await start()
  try {
    vehicle.each((name, message) => { if (name === 'StatusText') texts.push(message.text) })
    await get_to_know()
    const parameters = await read_parameters()
    await set_parameter('CTL_FEEDFWD', 0)
    await set_parameter('CTL_FEEDFWD', 0.5, true)  // it is a switch
    await disturb()
    await fly()
    assert.ok(texts.some(text => text.startsWith('boot')), `texts: ${texts}`)
    assert.ok(texts.includes('landed'), `texts: ${texts}`)
    flight.kill('SIGINT')
    assert.equal(await ended, 0, said())
    console.log(`${parameters.size} parameters; texts: ${texts.join('; ')}`)
  } finally {
    flight.kill('SIGKILL')
    await vehicle.close()
  }
  const path = realpathSync(folder + '/runs/latest'), flown = run_json(path)
  assert.equal(flown.verdict, 'none')
  console.log(said().trim().split('\n').slice(-7).join('\n'))
  const rerun = spawnSync(program, ['run', path + '/commands.lua', '--out', folder, '--json'],
                          { encoding: 'utf8', maxBuffer: 1 << 28 })
  const again = JSON.parse(rerun.stdout)
  assert.equal(again.verdict, 'pass', again.reason)
  assert.equal(again.digest, flown.digest, 'the recording flies the same flight')
  console.log(`flown again: digest ${again.digest} over ${again.virtual_s} s`)
}

await main()
