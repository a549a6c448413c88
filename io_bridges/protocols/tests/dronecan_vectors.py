#!/usr/bin/env python3
"""Prints DroneCAN frames for dronecan_golden_test.cpp, by a route that shares nothing with the code under test.

The DSDL's fields are strings of bits: a field's bytes from its low one upwards, in each byte the high bit first
(dronecan/DSDL b4653c7a; an array at the end has no length). float16 is struct's "e", the CRC binascii.crc_hqx.
It is judged by two frames of pydronecan, which it must make as well.
"""
import binascii
import struct


def u(value, bits):
    text = format(value & ((1 << bits) - 1), f"0{bits}b")
    return "".join(text[max(0, end - 8):end] for end in range(bits, 0, -8))


def f16(*values):
    return "".join(u(struct.unpack("<H", struct.pack("<e", x))[0], 16) for x in values)


def f32(*values):
    return "".join(u(struct.unpack("<I", struct.pack("<f", x))[0], 32) for x in values)


def octets(data):
    return "".join(u(byte, 8) for byte in data)


def void(bits):
    return "0" * bits


def frames(bits, signature, transfer_id):
    bits += void(-len(bits) % 8)
    payload = bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8))
    if len(payload) <= 7:
        return (payload + bytes([0xC0 | transfer_id])).hex()
    crc = binascii.crc_hqx(payload, binascii.crc_hqx(struct.pack("<Q", signature), 0xFFFF))
    data = struct.pack("<H", crc) + payload
    parts = [data[i:i + 7] for i in range(0, len(data), 7)]
    tails = [(0x80 if i == 0 else 0) | (0x40 if i == len(parts) - 1 else 0) | (0x20 if i % 2 else 0) | transfer_id
             for i in range(len(parts))]
    return " / ".join((part + bytes([tail])).hex() for part, tail in zip(parts, tails))


def message(priority, type_id, source):
    return f"{priority << 24 | type_id << 8 | source:08X}"


def service(type_id, asked, priority):
    to, source = (20, 10) if asked else (10, 20)
    return f"{priority << 24 | type_id << 16 | asked << 15 | to << 8 | 0x80 | source:08X}"


RAW_IMU, STATUS, BATTERY = 0x8280632C40E574B5, 0xA9AF28AEA2FBB254, 0x249C26548A711966
INFO, ALLOCATION, GET_SET = 0xEE468A8121C46A9E, 0x0B2A812620A11D40, 0xA7B622F939D1A4D5

imu = u(1000000, 56) + f32(0) + f16(0.01, -0.02, 0.03) + f32(0, 0, 0) + f16(0, 0, -9.8125) + f32(0, 0, 0)
assert frames(imu, RAW_IMU, 0) == (
    "b5d040420f000080 / 0000000000001f20 / 211fa5ae27000000 / 0000000000000020 / 0000000000000000 / "
    "e8c8000000000020 / 0000000000000040")
status = u(0, 32) + f16(16, 10, 300) + u(5000, 18) + u(50, 7) + u(2, 5)
assert frames(status, STATUS, 7) == "33a5000000000087 / 4c0049b05c881327 / 190847"


def battery(numbers, flags, health, charge, deviation, number, instance, name):
    return (f16(*numbers) + u(flags, 11) + u(health, 7) + u(charge, 7) + u(deviation, 7) + u(number, 8) +
            u(instance, 32) + octets(name))


def allocation(node_id, first, part):
    return u(node_id, 7) + u(first, 1) + octets(part)


def integer(value, tag_bits=3):
    return u(1, tag_bits) + u(value, 64)


uid = bytes(range(0x11, 0x21))
info = (u(0x01020304, 32) + u(1, 2) + u(3, 3) + u(5, 3) + u(0xABCD, 16) + u(2, 8) + u(18, 8) + u(3, 8) +
        u(0xD001F897, 32) + u(0x0123456789ABCDEF, 64) + u(4, 8) + u(1, 8) + octets(uid) + u(2, 8) +
        octets(b"\x5a\xa5") + octets(b"org.am32"))
for name, can_id, bits, signature, transfer_id in [
    ("BatteryInfo", message(16, 1092, 45),
     battery((300, 15.5, -12.25, 180, 30.5, 37, 1.5), 0x2A5, 127, 83, 4, 2, 0xDEADBEEF, b"hv_4s"), BATTERY, 9),
    ("BatteryInfo", message(16, 1092, 45), battery((0, 11.1, 0, 0, 0, 0, 0), 1, 0, 100, 0, 0, 0, b""), BATTERY, 0),
    ("GetNodeInfo request", service(1, True, 30), "", INFO, 3),
    ("GetNodeInfo response", service(1, False, 30), info, INFO, 3),
    ("Allocation request", "", allocation(0, True, uid[:6]), ALLOCATION, 0),
    ("Allocation request", "", allocation(0, False, uid[6:12]), ALLOCATION, 1),
    ("Allocation request", "", allocation(33, False, uid[12:]), ALLOCATION, 2),
    ("Allocation answer", message(30, 1, 10), allocation(0, False, uid[:6]), ALLOCATION, 0),
    ("Allocation answer", message(30, 1, 10), allocation(0, False, uid[:12]), ALLOCATION, 1),
    ("Allocation answer", message(30, 1, 10), allocation(125, False, uid), ALLOCATION, 2),
    ("GetSet request", service(11, True, 20), u(0x1234, 13) + u(2, 3) + f32(-0.75) + octets(b"motor_kv"), GET_SET, 1),
    ("GetSet request", service(11, True, 20), u(0, 13) + u(4, 3) + u(5, 8) + octets(b"hello") + octets(b"greeting"),
     GET_SET, 2),
    ("GetSet response", service(11, False, 20),
     void(5) + integer(-7) + void(5) + integer(0x1122334455667788) + void(6) + integer(100, 2) + void(6) +
     integer(-100, 2) + octets(b"gain"), GET_SET, 1),
    ("GetSet response", service(11, False, 20),
     void(5) + u(4, 3) + u(3, 8) + octets(b"abc") + void(5) + u(3, 3) + u(1, 8) + void(6) + u(0, 2) + void(6) +
     u(0, 2) + octets(b"word"), GET_SET, 2),
]:
    print(name, can_id, frames(bits, signature, transfer_id))
