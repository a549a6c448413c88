#include "harness/calibrate/procedure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace whirl::calibrate {
namespace {

constexpr std::int64_t kBoot_ms = 200, kStop_ms = 3000, kStart_ms = 2500;
constexpr unsigned kArmed = 1, kUncalibrated = 1u << 6;
constexpr double kStart_duty = 0.13;
constexpr double kMost_wind_mps = 19.0;

Error failed(const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, "stand", what, cure};
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class Mean {  // of what the instruments and the ESC say
 public:
  void add(const Instruments& read) {
    sum_.thrust_N += read.thrust_N;
    sum_.torque_Nm += read.torque_Nm;
    sum_.current_A += read.current_A;
    sum_.voltage_V += read.voltage_V;
    ++reads_;
  }
  void add(const io::EscSample& sample) {
    duty_ += sample.duty;
    speed_ += sample.speed_radps;
    current_ += sample.bus_current_A;
    square_ += static_cast<double>(sample.bus_current_A) * sample.bus_current_A;
    voltage_ += sample.bus_voltage_V;
    ++samples_;
  }
  bool any_sample() const { return samples_ > 0.0; }
  SteadyPoint point(double wind_mps) const {
    return {wind_mps,
            duty_ / samples_,
            speed_ / samples_,
            current_ / samples_,
            voltage_ / samples_,
            sum_.current_A / reads_,
            sum_.voltage_V / reads_,
            sum_.thrust_N / reads_,
            sum_.torque_Nm / reads_,
            1.96 * spread_A() / std::sqrt(samples_)};
  }

 private:
  double spread_A() const {
    const double mean = current_ / samples_;
    return std::sqrt(std::max(0.0, square_ / samples_ - mean * mean));
  }

  Instruments sum_;
  double duty_ = 0.0, speed_ = 0.0, current_ = 0.0, square_ = 0.0, voltage_ = 0.0;
  double reads_ = 0.0, samples_ = 0.0;
};

class Procedure {
 public:
  Procedure(Bench& bench, const Setup& setup, const Teller& tell)
      : bench_(bench), setup_(setup), tell_(tell) {
    data_.radius_m = 0.5 * setup.diameter_m;
    data_.density_kgpm3 = setup.density_kgpm3;
  }

  Result<StandData> go() {
    for (const auto step :
         {&Procedure::power_up, &Procedure::still, &Procedure::start_motor, &Procedure::steps,
          &Procedure::sinusoid, &Procedure::blown, &Procedure::updraft, &Procedure::zero,
          &Procedure::stop_motor, &Procedure::rest}) {
      if (auto good = (this->*step)(); !good) return good.error();
    }
    return std::move(data_);
  }

 private:
  Result<Done> power_up() {
    tell_("powering up");
    if (auto good = bench_.run(kBoot_ms); !good) return good;
    if (auto good = bench_.silence(); !good) return good;
    if (auto good = bench_.must("watch 0"); !good) return good;
    for (const char* line : {"set gain 1", "set offset 0"}) {  // whatever its flash may hold
      if (auto good = bench_.must(line); !good) return good;
    }
    if (auto good = bench_.must("stream " + number(kStream_Hz)); !good) return good;
    return bench_.run(setup_.warm_up_ms);
  }

  Result<Done> rest() {
    tell_("at rest");
    return measure(0.0, data_.rest, false);
  }

  Result<Done> start_motor() {
    tell_("starting");
    if (auto good = bench_.must("arm"); !good) return good;
    if (auto good = turn(kStart_duty); !good) return good;
    return bench_.run(kStart_ms);
  }

  Result<Done> stop_motor() {
    tell_("stopping");
    if (auto good = bench_.must("stop"); !good) return good;
    if (auto good = bench_.blow(0.0); !good) return good;
    return bench_.run(kStop_ms);
  }

  Result<Done> turn(double duty) { return bench_.must("duty " + number(100.0 * duty)); }

  // Every duty twice, in short runs that each start from a zero found anew: within seconds the shunt's
  // offset wanders by more than the current sense shall err.
  Result<Done> still() {
    for (std::size_t run = 0; run < 2 * kInterleaved; ++run) {
      if (auto good = rest(); !good) return good;
      if (auto good = start_motor(); !good) return good;
      for (std::size_t i = run % kInterleaved; i < setup_.still.size(); i += kInterleaved) {
        tell_("still air, duty " + number(100.0 * setup_.still[i]) + " %");
        if (auto good = turn(setup_.still[i]); !good) return good;
        if (auto good = measure(0.0, data_.still, true); !good) return good;
      }
      if (auto good = stop_motor(); !good) return good;
    }
    return rest();
  }

  Result<Done> blown() {
    for (const double wind_mps : setup_.winds_mps) {
      if (auto good = bench_.blow(wind_mps); !good) return good;
      for (const double duty : setup_.blown) {
        tell_("wind " + number(wind_mps) + " m/s, duty " + number(100.0 * duty) + " %");
        if (auto good = turn(duty); !good) return good;
        if (auto good = measure(wind_mps, data_.blown, true); !good) return good;
      }
    }
    return Done{};
  }

  Result<Done> updraft() {
    if (!(setup_.updraft_mps > 0.0)) return Done{};
    tell_("updraft " + number(setup_.updraft_mps) + " m/s");
    if (auto good = bench_.blow(-setup_.updraft_mps); !good) return good;
    for (const double duty : setup_.blown) {
      if (auto good = turn(duty); !good) return good;
      if (auto good = measure(-setup_.updraft_mps, data_.updraft, true); !good) return good;
    }
    return Done{};
  }

  // The wind is raised until thrust changes its sign; two points or more lie beyond.
  Result<Done> zero() {
    if (auto good = turn(setup_.blown.front()); !good) return good;
    double wind_mps = setup_.winds_mps.back();
    for (int beyond = 0; beyond < 2 || data_.zero.size() < kFewest_about_zero;) {
      wind_mps += 0.5;
      if (wind_mps > kMost_wind_mps) return failed("no wind up to 19 m/s takes the thrust away");
      tell_("towards zero thrust, wind " + number(wind_mps) + " m/s");
      if (auto good = bench_.blow(wind_mps); !good) return good;
      if (bench_.instruments().thrust_N > kNear_N) continue;
      if (auto good = measure(wind_mps, data_.zero, true); !good) return good;
      if (data_.zero.back().thrust_N < 0.0) ++beyond;
    }
    return Done{};
  }

  // The stream's samples while `during` runs; the motor must keep turning.
  template <typename F>
  Result<Done> listen(const std::function<void(const io::EscSample&)>& sink, bool turning,
                      F during) {
    unsigned flags = kArmed;
    bench_.on_sample([&](const io::EscSample& sample) {
      flags &= sample.flags;
      sink(sample);
    });
    const Result<Done> done = during();
    bench_.on_sample(nullptr);
    if (!done || !turning || (flags & kArmed) != 0) return done;
    return failed("the ESC has stopped the motor", "smaller steps of duty in the file may help");
  }

  Result<Done> measure(double wind_mps, std::vector<SteadyPoint>& into, bool turning) {
    if (auto good = bench_.run(setup_.settle_ms); !good) return good;
    Mean mean;
    bench_.on_step([&](const Bench& bench) { mean.add(bench.instruments()); });
    const auto done = listen([&](const io::EscSample& sample) { mean.add(sample); }, turning,
                             [&] { return bench_.run(setup_.measure_ms); });
    bench_.on_step(nullptr);
    if (!done) return done;
    if (!mean.any_sample()) return failed("the ESC's stream is silent");
    into.push_back(mean.point(wind_mps));
    return Done{};
  }

  template <typename Law>  // duty by time
  Result<Done> follow(std::int64_t duration_ms, std::int64_t every_ms, std::vector<Sample>& into,
                      Law law) {
    const auto sink = [&](const io::EscSample& sample) {
      into.push_back({1e-3 * sample.tick, sample.duty, sample.speed_radps, sample.bus_current_A,
                      sample.bus_voltage_V});
    };
    return listen(sink, true, [&]() -> Result<Done> {
      for (std::int64_t ms = 0; ms < duration_ms; ms += every_ms) {
        const double duty = law(1e-3 * static_cast<double>(ms));
        if (auto good = bench_.type("duty " + number(100.0 * duty)); !good) return good;
        if (auto good = bench_.run(every_ms); !good) return good;
      }
      return Done{};
    });
  }

  Result<Done> steps() {
    tell_("steps of duty");
    if (auto good = turn(setup_.low_duty); !good) return good;
    if (auto good = bench_.run(setup_.settle_ms); !good) return good;
    return follow(kTransient_ms, 500, data_.steps, [this](double t_s) {
      return std::fmod(t_s, 1.0) < 0.5 ? setup_.high_duty : setup_.low_duty;
    });
  }

  Result<Done> sinusoid() {
    tell_("duty as a sinusoid");
    const double middle = 0.5 * (setup_.low_duty + setup_.high_duty);
    if (auto good = turn(middle); !good) return good;
    if (auto good = bench_.run(setup_.settle_ms); !good) return good;
    return follow(kTransient_ms, 10, data_.sinusoid, [&](double t_s) {
      return middle +
             (setup_.high_duty - middle) * std::sin(2.0 * std::numbers::pi * kSwing_Hz * t_s);
    });
  }

  static constexpr double kNear_N = 0.45;  // of zero thrust
  static constexpr std::size_t kFewest_about_zero = 5;
  static constexpr std::size_t kInterleaved = 3;  // runs that make up all points in still air
  static constexpr double kStream_Hz = 500.0, kSwing_Hz = 2.0;
  static constexpr std::int64_t kTransient_ms = 5000;

  Bench& bench_;
  const Setup& setup_;
  const Teller& tell_;
  StandData data_;
};

}  // namespace

Result<StandData> measure_all(Bench& bench, const Setup& setup, const Teller& tell) {
  auto data = Procedure(bench, setup, tell).go();
  bench.on_step(nullptr);
  return data;
}

Result<Done> store(Bench& bench, const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    if (auto good = bench.must(line); !good) return good;
  }
  for (const char* line : {"identified 1", "save"}) {
    if (auto good = bench.must(line); !good) return good;
  }
  unsigned flags = kUncalibrated;
  bench.on_sample([&](const io::EscSample& sample) { flags = sample.flags; });
  const auto done = bench.run(100);
  bench.on_sample(nullptr);
  if (!done || (flags & kUncalibrated) == 0) return done;
  return failed("the ESC still says that it is not calibrated");
}

}  // namespace whirl::calibrate
