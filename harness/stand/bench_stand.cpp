#include "harness/stand/bench_stand.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "base/check.hpp"

namespace whirl::stand {
namespace {

constexpr std::int64_t kUnread_ns = 250'000'000;

Error refused(const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, "", what, cure};
}

}  // namespace

BenchStand::BenchStand(BenchStandParams params)
    : params_(std::move(params)),
      master_(params_.esc),
      measured_(params_.readings.size()),
      seen_(params_.limits.size()) {}

Result<std::unique_ptr<BenchStand>> BenchStand::make(BenchStandParams params) {
  std::unique_ptr<BenchStand> stand(new BenchStand(std::move(params)));
  if (const auto named = stand->name_signals(); !named) return named.error();
  return stand;
}

Result<Done> BenchStand::name_signals() {
  for (std::size_t i = 0; i < params_.readings.size(); ++i) {
    const auto added = add_signal(
        params_.readings[i], [this, i] { return latest(i); }, i);
    if (!added) return added;
  }
  for (EscLine::Named& told : master_.signals()) {
    const auto added = add_signal(std::move(told.signal), std::move(told.value), std::nullopt);
    if (!added) return added;
  }
  for (const auto& [name, of] : params_.aliases) {
    const auto source = column(of);
    if (!source) return refused("signals: " + name + " = '" + of + "': there is no such signal");
    Signal alias = signals_[*source];
    alias.about = "is " + of + ": " + alias.about;
    alias.name = name;
    const auto added = add_signal(std::move(alias), values_[*source], read_by_[*source]);
    if (!added) return added;
  }
  for (const BenchLimit& limit : params_.limits) {
    const auto watched = column(limit.signal);
    if (!watched) {
      return refused("limits: there is no signal '" + limit.signal + "' to be watched",
                     "there are " + SignalTable(signals_).names());
    }
    if (signals_[*watched].dimension != limit.dimension) {
      return refused("limits: " + limit.signal + " is a " + name(signals_[*watched].dimension));
    }
  }
  return Done{};
}

Result<Done> BenchStand::add_signal(Signal signal, std::function<double()> value,
                                    std::optional<std::size_t> reading) {
  if (column(signal.name)) return refused("two signals are called '" + signal.name + "'");
  signals_.push_back(std::move(signal));
  values_.push_back(std::move(value));
  read_by_.push_back(reading);
  ages_ns_.push_back(0);
  return Done{};
}

std::optional<std::size_t> BenchStand::column(const std::string& name) const {
  const auto it = std::find_if(signals_.begin(), signals_.end(),
                               [&](const Signal& s) { return s.name == name; });
  if (it == signals_.end()) return std::nullopt;
  return static_cast<std::size_t>(it - signals_.begin());
}

double BenchStand::latest(std::size_t reading) const {
  const auto& measured = measured_[reading];
  if (!measured || now_ns_ - measured->t_ns > kUnread_ns) return std::nan("");
  return measured->value;
}

void BenchStand::read(std::span<double> values) const {
  WHIRL_CHECK(values.size() == values_.size(), values.size(), values_.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = values_[i]();
}

void BenchStand::step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) {
  for (io::Reader reader(happened.bytes()); reader.next();) {
    const io::Header& header = reader.header();
    if (header.kind != io::Kind::instrument_reading) {
      master_.on_message(reader);
    } else if (header.port < measured_.size()) {
      measured_[header.port] = {header.t_ns, reader.as<io::InstrumentReading>().value};
    }
  }
  now_ns_ = t_ns;
  for (std::size_t i = 0; i < read_by_.size(); ++i) {
    if (read_by_[i] && measured_[*read_by_[i]]) ages_ns_[i] = t_ns - measured_[*read_by_[i]]->t_ns;
  }
  if (const auto why = beyond_limits()) {
    sensed.add(io::Kind::emergency_stop, 0, t_ns, why->data(),
               static_cast<std::uint32_t>(why->size()));
  }
  master_.send(t_ns, sensed);
}

std::optional<std::string> BenchStand::beyond_limits() {
  for (std::size_t i = 0; i < params_.limits.size(); ++i) {
    const BenchLimit& limit = params_.limits[i];
    const double value = values_[*column(limit.signal)]();
    if (std::isnan(value) && !seen_[i]) continue;  // it may take its time to begin
    seen_[i] = true;
    if (value >= limit.low && value <= limit.high) continue;
    char text[240];
    if (std::isnan(value)) {
      std::snprintf(text, sizeof text, "%s is not measured any more", limit.signal.c_str());
    } else {
      std::snprintf(text, sizeof text, "%s is %.6g, and the bench's limits are %.6g and %.6g (SI)",
                    limit.signal.c_str(), value, limit.low, limit.high);
    }
    return text;
  }
  return std::nullopt;
}

Result<Done> BenchStand::command(const Command& command, std::int64_t /*now_ns*/) {
  const auto taken = master_.take(command);
  if (!taken) return taken.error();
  if (taken.value()) return Done{};
  return not_understood("a bench", word(command));
}

Result<Done> BenchStand::disturb(const Disturbance& disturbance, std::int64_t /*now_ns*/) {
  return not_understood("a bench", word(disturbance));
}

std::string BenchStand::status() const {
  std::string text;
  for (std::size_t i = 0; i < params_.readings.size() && i < 4; ++i) {
    char one[80];
    std::snprintf(one, sizeof one, "%s%s %.4g %s", i == 0 ? "" : ", ", signals_[i].name.c_str(),
                  values_[i](), si_symbol(signals_[i].dimension));
    text += one;
  }
  return text;
}

}  // namespace whirl::stand
