-- How much of its processor the flight image takes in a hover, and at which rates its tasks run. Limits are 1.3 times the
-- worst of seeds 1 to 20 in 5 s, and never above the thesis's (Table 6.2: velocity-aided filter 9.6 %, quaternion filter
-- 2 % of 168 MHz; whole image 60 %). So they guard against what an image takes more without meaning to; one that means
-- to is measured anew:
--   whirl run test_plans/flight/budgets.lua --seeds 1..20 --jobs 2
-- Seeds hardly differ: the worst calls take the same path.
-- No `margin` beside that: it is asked of requirements, for the clock's 10 %. Of these limits fw::imu_task has 7 % left
-- (5.38 us, seed 5), the others 16 to 24 %; of the thesis's all have 90 % and more.
-- Rates are judged by the IMU's own samples: its clock, up to 1 % off by the data sheet, is told beside each.
include "include/hover.lua"

local tasks = {
  -- function, 1.3 x its worst execution (worst), IMU samples to a call
  { "fw::imu_task", "5.8 us", 1 }, -- 4.43 us
  { "fw::attitude_task", "69.3 us", 5 }, -- 53.3 us
  { "fw::position_task", "19.5 us", 25 }, -- 15.0 us
  { "fw::sensor_task", "30.0 us", 10 }, -- 23.05 us
  { "fw::gps_task", "17.8 us", 5 }, -- 13.67 us
  { "fw::esc_task", "8.4 us" }, -- 6.44 us; its calls are no one period's
  { "fw::telemetry_task", "87.5 us", 5 }, -- 67.3 us
  { "fw::log_task", "245 us", 1 }, -- 188.7 us
}

plan "budgets" {
  image = "flight", board = "px4fmu_v1", vehicle = "hp_quad",
  tags = { "flight" }, timeout = "60 s",
  run = function(t)
    hover(t)
    for _, task in ipairs(tasks) do
      t:budget(task[1]) { execution = task[2], during = "5 s" }
      if task[3] then t:budget(task[1]) { rate = "1 %", every = task[3], of = "imu", during = "5 s" } end
    end
    t:budget("fw::Estimator::step_aided") { execution = "19.5 us", share = "0.386 %", during = "5 s" } -- 15.0 us, 0.297 %
    t:budget("fw::Estimator::step_explicit") { execution = "4.6 us", share = "0.091 %", during = "5 s" } -- 3.54 us, 0.0698 %
    t:budget("cpu") { busy = "6.4 %", during = "5 s" } -- 4.93 %
    t:budget("stack") { depth = "3772 B" } -- 2902 B, on each seed; 16 KiB are set aside for it
    local hover = t:record({ "height", "offset" }, "5.1 s")
    t:expect(hover:rms_error("height", "1.1 m"), "hover: height RMS error"):at_most "5 cm"
  end,
}
