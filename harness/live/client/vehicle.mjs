// A vehicle at the other end of a UDP port, as node-mavlink reads and writes it.
import { common, minimal, standard, MavEsp8266, MavLinkProtocolV2 } from 'node-mavlink'

const kMessages = { ...minimal.REGISTRY, ...standard.REGISTRY, ...common.REGISTRY }
const kStation = { system: 255, component: 190 }

export class Vehicle {
  #port = new MavEsp8266()
  #newest = {}    // of each message, by its class's name
  #waiting = []

  // Listens on a port of ours that is free; it is given back.
  async listen() {
    this.#port.on('data', packet => this.#hear(packet))
    await this.#port.start(0, 0, '127.0.0.1')
    return this.#port.socket.address().port
  }
  talk_to(port) { this.#port.sendPort = port }
  async close() { await this.#port.close() }

  #hear(packet) {
    if (packet.header.sysid !== 1 || packet.header.compid !== 1) return
    const type = kMessages[packet.header.msgid]
    if (!type) return
    const message = packet.protocol.data(packet.payload, type)
    this.#newest[type.name] = message
    for (const one of [...this.#waiting]) one(type.name, message)
  }

  send(message) { return this.#port.send(message, kStation.system, kStation.component) }
  send_bytes(bytes) { return this.#port.sendBuffer(Buffer.from(bytes)) }
  bytes_of(message) {
    return new MavLinkProtocolV2(kStation.system, kStation.component).serialize(message, 0)
  }

  // The next message of this class that is as wanted; rejects after so many seconds of the host.
  next(type, wanted = () => true, limit_s = 60) {
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => {
        this.#forget(hear)
        reject(new Error(`no ${type.name} as wanted within ${limit_s} s; the newest: ` +
                         JSON.stringify(this.#newest[type.name] ?? null, as_text)))
      }, 1000 * limit_s)
      const hear = (name, message) => {
        if (name !== type.name || !wanted(message)) return
        clearTimeout(timer)
        this.#forget(hear)
        resolve(message)
      }
      this.#waiting.push(hear)
    })
  }
  #forget(hear) { this.#waiting = this.#waiting.filter(one => one !== hear) }
  each(hear) { this.#waiting.push((name, message) => hear(name, message)) }

  // Sends it until it is answered, as a ground station does: a radio may lose it.
  async ask(message, type, wanted, tries = 10) {
    for (let i = 1; ; ++i) {
      const answer = this.next(type, wanted, 5)
      await this.send(message)
      try { return await answer } catch (error) { if (i === tries) throw error }
    }
  }

  // The result of its COMMAND_ACK.
  async command(number, params = {}) {
    const message = new common.CommandLong()
    message.targetSystem = message.targetComponent = 1
    message.command = number
    for (let i = 1; i <= 7; ++i) message[`_param${i}`] = params[i] ?? 0
    return (await this.ask(message, common.CommandAck, ack => ack.command === number)).result
  }
}

export function as_text(_, value) { return typeof value === 'bigint' ? String(value) : value }
