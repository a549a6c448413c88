#include "firmware/esc/image/commands.hpp"

#include <array>

#include "firmware/esc/core/parameters.hpp"
#include "firmware/esc/core/pulse_throttle.hpp"
#include "firmware/esc/core/still_air.hpp"
#include "firmware/esc/image/i2c_slave.hpp"
#include "firmware/esc/image/registers.hpp"
#include "firmware/esc/image/serial.hpp"
#include "firmware/esc/image/stream.hpp"
#include "firmware/esc/image/text_number.hpp"
#include "firmware/hal/interrupts.hpp"

namespace fw::esc {
namespace {

// The core belongs to the tick.
using TickLock = hal::PriorityLock<f103::kPriorityControl>;

class Line {  // what is being answered
 public:
  Line& text(std::string_view words) {
    for (const char c : words) {
      if (length_ < text_.size()) text_[length_++] = c;
    }
    return *this;
  }
  Line& number(std::int32_t value) {
    if (value < 0) text("-");
    std::uint32_t rest =
        value < 0 ? 0u - static_cast<std::uint32_t>(value) : static_cast<std::uint32_t>(value);
    std::array<char, 10> digits{};
    std::size_t n = 0;
    do {
      digits[n++] = static_cast<char>('0' + rest % 10);
      rest /= 10;
    } while (rest != 0);
    while (n > 0) text({&digits[--n], 1});
    return *this;
  }
  Line& real(float value) {
    NumberText digits;
    return text(write_number(value, digits));
  }
  ~Line() {
    text("\r\n");
    serial::put({text_.data(), length_});  // no room: the asker has to ask again
  }

 private:
  std::array<char, 152> text_{};  // the longest answer is commands' list
  std::size_t length_ = 0;
};

struct Words {
  std::string_view verb, first, second;
};

Words split(std::string_view line) {
  Words words;
  std::string_view* const into[] = {&words.verb, &words.first, &words.second};
  for (std::string_view* word : into) {
    while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
    std::size_t length = 0;  // not substr(): its range check would bring in exceptions
    while (length < line.size() && line[length] != ' ') ++length;
    *word = {line.data(), length};
    line.remove_prefix(length);
  }
  return words;
}

struct ModeWord {
  std::string_view verb;
  Mode mode;
  float scale;  // to the unit of range_of()
};
constexpr ModeWord kModes[] = {{"duty", Mode::duty, 0.01f},
                               {"rpm", Mode::speed, kRadps_per_rpm},
                               {"thrust", Mode::thrust_by_speed, 1.0f},
                               {"power", Mode::power, 1.0f},
                               {"st", Mode::thrust_by_power, 1.0f}};

void report_status(const Core& core) {
  Line line;
  line.text("mode ").number(static_cast<int>(core.mode()));
  line.text(" flags ").number(core.flags());
  line.text(" rpm ").number(static_cast<std::int32_t>(core.speed_radps() / kRadps_per_rpm));
  line.text(" mA ").number(static_cast<std::int32_t>(1000.0f * core.bus_current_A()));
  line.text(" mV ").number(static_cast<std::int32_t>(1000.0f * core.bus_voltage_V()));
  line.text(" mN ").number(static_cast<std::int32_t>(1000.0f * core.estimator().thrust_N()));
  line.text(" mW ").number(static_cast<std::int32_t>(1000.0f * core.estimator().power_W()));
  line.text(core.estimator().observable() ? " seen" : " assumed");
}

// What power tells of inflow now, and what an ampere of the bus too much would do to the thrust.
void report_inflow(const Core& core) {
  const ThrustEstimator& found = core.estimator();
  Line line;
  line.text("ls ").real(found.solution().ls);
  line.text(" slope ").real(found.solution().slope);
  line.text(" leverage ").real(found.solution().leverage);
  line.text(" N/A ").real(found.thrust_per_ampere());
  line.text(" iterations ").number(found.solution().iterations);
  line.text(found.observable() ? " seen" : " assumed");
}

void answer(bool good) {
  Line().text(good ? "ok" : "refused");
}

bool recalibrate(const Calibration& changed, Core& core, Settings& settings) {
  const TickLock lock;
  if (!core.recalibrate(changed)) return false;
  settings.calibration = changed;
  return true;
}

bool set_parameter(const Words& words, Core& core, Settings& settings) {
  float value = 0.0f;
  if (!parse_number(words.second, value)) return false;
  for (const Parameter& parameter : kParameters) {
    if (parameter.name != words.first) continue;
    Calibration changed = settings.calibration;
    parameter.in(changed) = value;
    return recalibrate(changed, core, settings);
  }
  return false;
}

bool get(std::string_view name, Settings& settings) {
  const bool all = name == "all";
  bool found = false;
  for (const Parameter& parameter : kParameters) {
    if (!all && parameter.name != name) continue;
    Line().text(parameter.name).text(" ").real(parameter.in(settings.calibration));
    found = true;
  }
  const struct {
    std::string_view name;
    std::int32_t value;
  } whole[] = {{"mode", static_cast<std::int32_t>(settings.calibration.mode)},
               {"motor", static_cast<std::int32_t>(settings.motor_number)},
               {"identified", settings.calibration.identified ? 1 : 0},
               {"i2c_rejected", static_cast<std::int32_t>(i2c_slave::rejected())},
               {"i2c_restarts", static_cast<std::int32_t>(i2c_slave::restarts())}};
  for (const auto& entry : whole) {
    if (!all && entry.name != name) continue;
    Line().text(entry.name).text(" ").number(entry.value);
    found = true;
  }
  return found;
}

bool set_mode(float value, Core& core, Settings& settings) {
  const TickLock lock;
  const bool taken = value >= 0.0f && value <= 5.0f &&
                     core.set_mode(static_cast<Mode>(static_cast<std::uint8_t>(value)));
  settings.calibration.mode = core.mode();
  return taken;
}

bool set_motor(float value, Settings& settings) {
  const bool valid = value >= 1.0f && value <= 4.0f;
  if (valid) settings.motor_number = static_cast<std::uint32_t>(value);
  return valid;  // the address changes at the next power-up
}

bool set_identified(bool identified, Core& core, Settings& settings) {
  Calibration changed = settings.calibration;
  changed.identified = identified;
  return recalibrate(changed, core, settings);
}

bool save(const Core& core, const Settings& settings) {
  const hal::InterruptLock lock;  // the flash answers nobody meanwhile
  return core.at_rest() && settings::save(settings);
}

bool arm(Core& core) {
  const TickLock lock;
  core.arm_by_hand();
  return core.supervisor().armed();
}

bool setpoint(const ModeWord& mode, float value, Core& core) {
  const TickLock lock;
  return core.command(mode.mode, mode.scale * value);
}

bool pwm(float width_us, Core& core) {  // as a pulse of that width would
  const bool valid = width_us >= 0.0f && width_us < 65'536.0f &&
                     PulseThrottle::in_range(static_cast<std::uint32_t>(width_us));
  if (!valid) return false;
  const TickLock lock;
  core.on_setpoint(PulseThrottle::setpoint_of(static_cast<std::uint32_t>(width_us)));
  return true;
}

struct StillAirAsked {
  StillAir air;
  bool asked = false;
  std::uint32_t ticks = 0;  // at the latest sample
};
constinit StillAirAsked still;

void begin_still() {
  still.air.begin();
  still.asked = true;
}

void stop(Core& core) {
  const TickLock lock;
  core.on_setpoint(0);
}

}  // namespace

void execute(std::string_view text, Core& core, Settings& settings) {
  const Words words = split(text);
  float value = 0.0f;
  const bool number = parse_number(words.first, value);
  for (const ModeWord& mode : kModes) {
    if (mode.verb == words.verb) return answer(number && setpoint(mode, value, core));
  }
  if (words.verb == "status") return report_status(core);
  if (words.verb == "inflow") return report_inflow(core);
  if (words.verb == "stop") return stop(core), answer(true);
  if (words.verb == "pwm") return answer(number && pwm(value, core));
  if (words.verb == "arm") return answer(arm(core));
  if (words.verb == "set") return answer(set_parameter(words, core, settings));
  if (words.verb == "get") {
    if (!get(words.first, settings)) answer(false);
    return;
  }
  if (words.verb == "stream") return answer(number && stream::set_rate(value));
  if (words.verb == "watch" && number) return core.watch(value != 0.0f), answer(true);
  if (words.verb == "mode" && number) return answer(set_mode(value, core, settings));
  if (words.verb == "motor" && number) return answer(set_motor(value, settings));
  if (words.verb == "identified" && number) {
    return answer(set_identified(value != 0.0f, core, settings));
  }
  if (words.verb == "still") return begin_still();
  if (words.verb == "save") return answer(save(core, settings));
  Line().text(
      "unknown: duty rpm thrust power st pwm | arm stop status inflow mode set get stream watch "
      "motor identified still save");
}

void go_on(std::uint32_t ticks, Core& core, Settings& settings) {
  using Answer = StillAir::Answer;
  if (!still.asked || ticks == still.ticks) return;
  still.ticks = ticks;
  Answer said = Answer::measuring;
  {
    const TickLock lock;
    said = still.air.sample(core);
    if (said == Answer::found) core.take_still_power(still.air.share());
  }
  if (said == Answer::measuring) return;
  still.asked = false;
  if (said == Answer::refused) return answer(false);
  settings.calibration.free_air = core.calibration().free_air;
  Line().text("still ").real(still.air.share());
}

}  // namespace fw::esc
