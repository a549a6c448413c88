-- The flight image's sensors and ESCs, a GPS and a receiver are the pod's, whose host is on its UART (pod_can.lua: on CAN).
include "include/flights.lua"
include "include/pod.lua"

pod_plan("pod hover", pod_hover)

-- Samples come to the pod up to 1 ms late, at random. What the flight controller's IMU task sees of it is to be no more
-- than the hover's 20 us and 5 of the pod's clock; the pod's clock has settled after its first second.
pod_plan("pod on a host that is uneven", function(t)
  heartbeat(t)
  local lost, late = figure(t, "pod_lost"), figure(t, "pod_late")
  t:budget("flight/fw::imu_task") { period = "1 ms", jitter = "25 us", during = "5 s", margin = "10 %" }
  t:wait "5 s"
  t:expect(figure(t, "pod_lost") - lost, "samples lost"):equal(0)
  t:expect(figure(t, "pod_late") - late, "data-ready that came late, of 5000"):at_most(5)
  t:expect(figure(t, "pod_wait_us"), "the longest that a sample waited, us"):at_most(1500)
end, "pod_with_jitter")

-- A hover is level, and cameras tell it where it is: an axis the wrong way round would not be seen there. Held at a slant,
-- each tells another part of what there is. Limits: zero-g output 80 mg, 3 % of scale and half a degree of
-- misalignment make 1.2 m/s2; a turn at up to 60 deg/s, told 10 times a second, 10 deg/s; a tenth of the earth's field. An
-- axis turned round is off by 12 m/s2, 60 deg/s, 20 uT.
pod_plan("pod in the hand", function(t)
  heartbeat(t)
  local axes = { "x", "y", "z" }
  local function judged(r, name, quantity, limit)
    for _, axis in ipairs(axes) do
      t:expect(r:max_error(quantity .. "_" .. axis, "0 " .. limit:match "%S+$"), name .. ": " .. quantity .. "_" .. axis):at_most(limit)
    end
  end
  for _, slant in ipairs { { "40 deg", "0 deg" }, { "0 deg", "40 deg" } } do
    local name = "roll " .. slant[1] .. ", pitch " .. slant[2]
    local turn = t:record({ "gyro_error_x", "gyro_error_y", "gyro_error_z" }, "1.5 s", function()
      t:hold { roll = slant[1], pitch = slant[2], height = "1.5 m", over = "1.5 s" }
    end)
    judged(turn, name .. ", turning", "gyro_error", "10 deg/s")
    t:wait "2 s"
    local still = t:record({ "accel_error_x", "accel_error_y", "accel_error_z", "field_error_x", "field_error_y", "field_error_z" }, "2 s")
    judged(still, name, "accel_error", "1.2 m/s2")
    judged(still, name, "field_error", "6 uT")
  end
end)

pod_receivers("pod receivers", "pod_with_receivers")
