#include "harness/target/bench/pod_counts.hpp"

#include <array>
#include <charconv>

namespace whirl::bench {
namespace {

constexpr std::int64_t kSettled_ns = 1'000'000'000;
constexpr long kWraps = 1 << 16;  // they are sixteen bits wide

constexpr const char* kClock = "pod_now_us";  // 0: it never told its status

struct Count {
  const char *name, *told;
};
constexpr std::array<Count, 6> kCounts{{{"pod_lost", "samples never reached the pod"},
                                        {"pod_late", "samples came late to it"},
                                        {"pod_damaged", "frames came damaged"},
                                        {"pod_oddities", "transfers it could not make sense of"},
                                        {"pod_overlaps", "commands came before it was ready"},
                                        {"pod_unsent", "of its own frames found no room"}}};

}  // namespace

bool PodCounts::hears(const io::Reader& told) {
  const io::Header& head = told.header();
  if (head.kind != io::Kind::uart_received || head.port != kPodHostUart) return false;
  const std::string line(told.payload().begin(), told.payload().end());
  const auto space = line.find(' ');
  long value = 0;
  if (space == std::string::npos) return true;
  std::from_chars(line.data() + space + 1, line.data() + line.size(), value);
  last_[line.substr(0, space)] = value;
  return true;
}

void PodCounts::ask() {
  for (const Count& count : kCounts) ask(count.name);
  ask(kClock);
}

void PodCounts::ask(const std::string& name) {
  io::Batch question;
  question.add(io::Kind::uart_frame, kPodHostUart, rack_.events().now(), name.data(),
               static_cast<std::uint32_t>(name.size()));
  io::Reader reader(question.bytes());
  if (reader.next()) rack_.on_message(reader);
}

void PodCounts::turn() {
  if (began_ && first_.empty()) first_ = last_;
  if (began_ || rack_.events().now() < kSettled_ns) return;
  began_ = true;
  ask();
}

void PodCounts::finish() {
  rack_.happened().clear();
  ask();
  for (io::Reader r(rack_.happened().bytes()); r.next();) hears(r);
}

std::vector<std::string> PodCounts::findings() const {
  std::vector<std::string> all;
  if (!began_) return all;
  const auto clock = last_.find(kClock);
  if (clock == last_.end() || clock->second == 0) return {"the pod said nothing"};
  for (const Count& count : kCounts) {
    const auto first = first_.find(count.name), last = last_.find(count.name);
    if (first == first_.end() || last == last_.end()) continue;
    const long counted = (last->second - first->second + kWraps) % kWraps;
    if (counted > 0) all.push_back(std::to_string(counted) + " " + count.told);
  }
  return all;
}

}  // namespace whirl::bench
