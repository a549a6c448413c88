// Reads a flight log with Foxglove's reader of ULog and holds it against the run's own words and truth:
// read_ulog.js FILE.ulg RUN_FOLDER. Prints what it found; fails where they differ.
"use strict";
const fs = require("fs");
const { ULog } = require("@foxglove/ulog");
const { FileReader } = require("@foxglove/ulog/node");

const kData = "D".charCodeAt(0), kDropout = "O".charCodeAt(0);
const kHeightLimit_m = 0.05;  // what is estimated is not the truth; as in test_plans/flight/flight_log.lua

// Heights of truth.csv by their millisecond.
function heights(folder) {
  const rows = fs.readFileSync(folder + "/truth.csv", "utf8").trim().split("\n");
  const names = rows[0].split(","), time = names.indexOf("t_s"), height = names.indexOf("height_m");
  const all = new Map();
  for (const row of rows.slice(1)) {
    const cells = row.split(",");
    all.set(Math.round(1000 * Number(cells[time])), Number(cells[height]));
  }
  return all;
}

async function main([file, folder]) {
  const log = new ULog(new FileReader(file));
  await log.open();
  const truth = heights(folder);
  let samples = 0, dropouts = 0, compared = 0, worst_m = 0, from_us = Infinity, to_us = 0;
  for await (const message of log.readMessages()) {
    if (message.type === kDropout) ++dropouts;
    if (message.type !== kData) continue;
    ++samples;
    const { z, timestamp } = message.value;
    from_us = Math.min(from_us, Number(timestamp));  // of samples alone: its timeRange() has texts, too
    to_us = Math.max(to_us, Number(timestamp));
    const height_m = truth.get(Math.round(Number(timestamp) / 1000));
    if (z === undefined || log.subscriptions.get(message.msgId).name !== "vehicle_local_position") continue;
    if (height_m === undefined) continue;
    ++compared;
    worst_m = Math.max(worst_m, Math.abs(height_m + z));
  }
  const said = JSON.parse(fs.readFileSync(folder + "/run.json", "utf8")).flight_logs[0];
  const facts = {
    "sys_name": [log.header.information.get("sys_name"), "Whirlstand"],
    "samples": [samples, said.samples],
    "dropouts": [dropouts, said.dropouts],
    "first sample, us": [from_us, Math.round(1e6 * said.from_s)],
    "last sample, us": [to_us, Math.round(1e6 * said.to_s)],
  };
  let good = compared > 1000 && worst_m <= kHeightLimit_m;
  console.log(`${compared} heights compared with truth, at most ${worst_m.toFixed(4)} m off`);
  for (const [name, [here, there]] of Object.entries(facts)) {
    console.log(`${name}: ${here}, the run says ${there}`);
    good = good && here === there;
  }
  return good ? 0 : 1;
}

main(process.argv.slice(2)).then(code => process.exit(code), error => {
  console.error(error);
  process.exit(1);
});
