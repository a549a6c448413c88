// The two things that a pod stands between, for its proof: a flight controller that does on SPI what was
// recorded of it, and the host that sends the samples which that controller was given then.
//
//   Time     a sample leaves the host when the recorded part's interrupt line rose, 2 ms later; the
//            transfer that followed starts as long after the pod's line rises as it did then. Others
//            keep their distance from the one before
//   Judged   byte by byte against what the recorded part answered. `waited` is how long an answer had
//            stood in DR when its first bit went out: the slack; nothing there in time is `late`
//   Out      lines "NAME NUMBER" as from a terminal on the UART: the answer to a line NAME; to "done" at
//            the end of the traffic. Who has asked nothing by then gets all of them, last "done 1"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "io_bridges/devices/spi_master.hpp"
#include "io_bridges/rack/devices/pod_host_link.hpp"
#include "io_bridges/rack/devices/spi_traffic.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kBehind_ns = 2'000'000;  // the replay's clock after the recording's
// When the controller would do without a data-ready, and how long the pod's last status may be off: it tells
// each 10 ms over the UART, each 30 ms over CAN, where a sample is three frames behind one of others.
struct Patience {
  Nanoseconds ready_ns, status_ns;
};
constexpr Patience kOver_uart{500'000, 25'000'000}, kOver_can{800'000, 75'000'000};

// Of the answers of one kind.
struct Answers {
  std::uint64_t bytes = 0, wrong = 0, late = 0;
  Nanoseconds least_wait_ns = std::numeric_limits<Nanoseconds>::max();
  void add(bool right, Nanoseconds waited_ns) {
    ++bytes;
    if (!right) ++wrong;
    if (waited_ns == io::SpiSlave::kNothing) ++late;
    if (waited_ns != io::SpiSlave::kNothing) least_wait_ns = std::min(least_wait_ns, waited_ns);
  }
};

// Of what takes time.
struct Spread {
  std::uint64_t count = 0;
  Nanoseconds least_ns = std::numeric_limits<Nanoseconds>::max(), most_ns = 0;
  double sum_ns = 0.0;
  void add(Nanoseconds ns) {
    ++count;
    least_ns = std::min(least_ns, ns);
    most_ns = std::max(most_ns, ns);
    sum_ns += static_cast<double>(ns);
  }
};

class PodReplayDevice final : public RackDevice {
 public:
  PodReplayDevice(DeviceSlot& slot, std::vector<RecordedTransfer> traffic)
      : queue_(slot.rack().events()),
        traffic_(std::move(traffic)),
        register_Hz_(slot.quantity("params.register_rate")),
        burst_Hz_(slot.quantity("params.burst_rate")),
        lose_every_(slot.whole("params.lose_every")),
        master_(queue_, slot.spi_slave(), slot.pin("cs"), 3),
        reader_([this](const io::PodStatus& status) { status_ = status; }),
        link_(slot, reader_),
        next_(queue_, [this] { start_transfer(); }),
        sample_(queue_, [this] { send_sample(); }),
        end_(queue_, [this] { end(); }) {
    slot.pin("int").watch([this](bool level, Nanoseconds now) {
      if (level) ready(now);
    });
    prepare();
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::uart_frame, link_.uart()}}; }
  void on_message(const io::Reader& message) override {
    const std::string line = PodHostLink::asked(message);
    asked_ = true;
    if (ended_ || line != "done") return answer(line);
    done_asked_ = true;
  }

 private:
  const RecordedTransfer& recorded() const { return traffic_[at_]; }
  const Patience& patience() const { return link_.over_can() ? kOver_can : kOver_uart; }

  // When the next transfer is due, and the sample before it.
  void prepare() {
    if (at_ == traffic_.size()) return end_.in(patience().status_ns);
    const RecordedTransfer& t = recorded();
    if (t.ready_ns < 0) {
      const Nanoseconds apart_ns = at_ == 0 ? 0 : t.start_ns - traffic_[at_ - 1].start_ns;
      return next_.at(at_ == 0 ? t.start_ns + kBehind_ns : begun_ns_ + apart_ns);
    }
    rose_ns_ = io::kNever;
    sample_.at(t.ready_ns + kBehind_ns);
    next_.at(t.ready_ns + kBehind_ns + patience().ready_ns);
  }

  void send_sample() {
    const RecordedTransfer& t = recorded();
    std::array<std::int16_t, 7> counts{};
    for (std::size_t i = 0; i < counts.size() && 2 * i + 2 < t.miso.size(); ++i) {
      counts[i] = static_cast<std::int16_t>(t.miso[2 * i + 1] << 8 | t.miso[2 * i + 2]);
    }
    sent_ns_ = queue_.now();
    ++samples_;
    const bool lost = lose_every_ != 0 && samples_ % lose_every_ == 0;
    if (lost) ++withheld_;
    if (!lost) link_.send_sample(number_, counts);
    ++number_;
  }

  void ready(Nanoseconds now) {
    if (at_ == traffic_.size() || recorded().ready_ns < 0 || rose_ns_ != io::kNever) return;
    rose_ns_ = now;
    link_delay_.add(now - sent_ns_);
    next_.at(now + recorded().start_ns - recorded().ready_ns);
  }

  void start_transfer() {
    const RecordedTransfer& t = recorded();
    if (master_.busy()) return next_.in(1000);
    if (t.ready_ns >= 0 && rose_ns_ == io::kNever) ++no_ready_;
    begun_ns_ = queue_.now();
    const bool burst = t.mosi[0] == kBurst && t.mosi.size() > 2;
    const double recorded_Hz = 8e9 / static_cast<double>(t.byte_ns);
    const double other_Hz = burst ? burst_Hz_ : register_Hz_;
    master_.transfer({t.mosi, other_Hz > 0.0 ? other_Hz : recorded_Hz, t.lead_ns, t.tail_ns},
                     [this, burst](const io::SpiReply& reply) { compare(reply, burst); });
  }

  void compare(const io::SpiReply& reply, bool burst) {
    const RecordedTransfer& t = recorded();
    const bool answerable = !burst || t.ready_ns < 0 || rose_ns_ != io::kNever;
    if (burst && !answerable) ++stale_;  // the sample never came: nothing to compare with
    for (std::size_t i = 0; i < reply.miso.size() && answerable; ++i) {
      Answers& kind = i == 0                    ? commands_
                      : burst                   ? bursts_
                      : (t.mosi[0] & 0x80) != 0 ? reads_
                                                : writes_;
      kind.add(reply.miso[i] == t.miso[i], reply.waited_ns[i]);
    }
    if (first_wrong_ns_ < 0 && answerable && reply.miso != t.miso) first_wrong_ns_ = t.start_ns;
    if (at_ > 0) gap_.add(reply.start_ns - stopped_ns_);
    stopped_ns_ = reply.stop_ns;
    ++at_;
    prepare();
  }

  void add(const std::string& name, double value) {
    figures_.emplace_back(name, std::llround(value));
  }
  void add(const std::string& name, const Answers& answers) {
    add(name + "_bytes", static_cast<double>(answers.bytes));
    add(name + "_wrong", static_cast<double>(answers.wrong));
    add(name + "_late", static_cast<double>(answers.late));
    const bool any = answers.bytes > answers.late;
    add(name + "_least_wait_ns", any ? static_cast<double>(answers.least_wait_ns) : -1.0);
  }
  void add(const std::string& name, const Spread& spread) {
    if (spread.count == 0) return;
    add(name + "_least_ns", static_cast<double>(spread.least_ns));
    add(name + "_mean_ns", spread.sum_ns / static_cast<double>(spread.count));
    add(name + "_most_ns", static_cast<double>(spread.most_ns));
  }

  void end() {
    ended_ = true;
    add("transfers", static_cast<double>(traffic_.size()));
    add("samples", static_cast<double>(samples_));
    add("withheld", static_cast<double>(withheld_));
    add("no_ready", static_cast<double>(no_ready_));
    add("stale", static_cast<double>(stale_));
    add("first_wrong_ns", static_cast<double>(first_wrong_ns_));  // of the recording; -1: none
    add("command", commands_);
    add("burst", bursts_);
    add("read", reads_);
    add("write", writes_);
    add("link", link_delay_);
    add("gap", gap_);
    for (const auto& figure : figures_of(status_)) figures_.push_back(figure);
    add("done", 1.0);
    if (done_asked_) answer("done");
    if (asked_) return;
    for (const auto& [name, value] : figures_) link_.tell(name, value);
  }

  void answer(const std::string& name) {
    if (!link_.tell(name, figures_)) link_.tell("unknown_or_not_yet", 0);
  }

  io::EventQueue& queue_;
  std::vector<RecordedTransfer> traffic_;
  std::size_t at_ = 0;
  double register_Hz_, burst_Hz_;  // 0: as recorded
  std::uint16_t lose_every_;
  io::SpiMaster master_;
  io::PodLinkReader reader_;
  PodHostLink link_;
  io::PodStatus status_;
  io::Event next_, sample_, end_;
  Nanoseconds begun_ns_ = 0, stopped_ns_ = 0, sent_ns_ = 0, rose_ns_ = io::kNever;
  std::uint8_t number_ = 0;
  std::uint64_t samples_ = 0, withheld_ = 0, no_ready_ = 0, stale_ = 0;
  Nanoseconds first_wrong_ns_ = -1;
  Answers commands_, bursts_, reads_, writes_;
  Spread link_delay_, gap_;
  PodFigures figures_;
  bool ended_ = false, asked_ = false, done_asked_ = false;
};

std::unique_ptr<RackDevice> make_replay(DeviceSlot& slot) {
  auto traffic = read_traffic(slot.text("params.traffic"));
  if (!traffic) {
    std::ignore = slot.failed(traffic.error());
    return nullptr;
  }
  return std::make_unique<PodReplayDevice>(slot, std::move(traffic.value()));
}

}  // namespace

DeviceType pod_replay_type() {
  DeviceKey lose = quantity_key("params.lose_every", Dimension::none, "", {0.0, 1000.0},
                                "every so many samples the host keeps one back");
  lose.kind = KeyKind::whole;
  const auto rate = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::frequency, "MHz", {0.0, 42e6}, about).with(0.0);
  };
  std::vector<DeviceKey> keys = {
      bus_key("spi", "of which the board is the slave").need().own(),
      pin_key("cs", "chip select, which it drives").need(),
      pin_key("int", "the pod's data-ready").need(),
      file_key("params.traffic", "the recording: io_bridges/rack/devices/spi_traffic.hpp").need(),
      rate("params.register_rate", "of SCK where single registers pass; 0: as recorded"),
      rate("params.burst_rate", "of SCK in bursts; 0: as recorded"),
      lose.with(0.0)};
  for (const DeviceKey& key : pod_link_keys()) keys.push_back(key);
  return {"pod_replay",
          "the flight controller and the host of a pod, by a recording: for its proof",
          std::move(keys), make_replay};
}

}  // namespace whirl::rack
