// A ULog file as columns of numbers: the reader for plans, tests and a run's page.
//
//   Names    of columns as readers of ULog have them: "x", "q[0]", "esc[1].esc_rpm"
//   Source   PX4 Developer Guide, "ULog File Format", version 1
//   End      a file that was not closed has zeros behind its last message: `records_bytes` says how far it
//            is a log, `closed` whether that is all of it. What cannot be a message ends it too, with `damage`
//   Left out appended data, tagged texts, encryption; messages of other types are passed over
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace whirl::results {

struct ULogTopic {
  std::vector<std::uint64_t> time_us;
  std::map<std::string, std::vector<double>> columns;  // without `timestamp`
};

struct ULogDropout {
  std::uint64_t after_us = 0;  // time of the last message before it
  std::uint16_t duration_ms = 0;
};

struct ULogText {
  char level = '6';
  std::uint64_t time_us = 0;
  std::string words;
};

struct ULog {
  std::uint64_t start_us = 0;
  std::map<std::string, std::string> infos;  // of texts: the words; else empty
  std::map<std::string, double> parameters;
  std::map<std::string, ULogTopic> topics;
  std::vector<ULogDropout> dropouts;
  std::vector<ULogText> texts;
  std::size_t records_bytes = 0;
  bool closed = false;
  std::string damage;  // empty: none

  std::size_t samples() const;
  std::uint64_t first_us() const, last_us() const;  // of all samples; 0: none
};

ULog read_ulog(std::span<const std::uint8_t> bytes);

}  // namespace whirl::results
