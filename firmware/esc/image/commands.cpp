#include "firmware/esc/image/commands.hpp"

#include <array>

#include "firmware/esc/core/parameters.hpp"
#include "firmware/esc/image/serial.hpp"

namespace fw::esc {
namespace {

// "3.25", "-1.2e-7": what people and the stand write. False: not a number, or something follows.
bool parse(std::string_view text, float& value) {
  std::size_t i = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) ++i;
  float number = 0.0f;
  int digits = 0, scale = 0;
  bool fraction = false;
  for (; i < text.size(); ++i) {
    if (text[i] >= '0' && text[i] <= '9') {
      number = 10.0f * number + static_cast<float>(text[i] - '0');
      scale -= fraction ? 1 : 0;
      ++digits;
    } else if (text[i] == '.' && !fraction) {
      fraction = true;
    } else {
      break;
    }
  }
  if (digits == 0) return false;
  if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
    float exponent = 0.0f;
    const std::string_view rest(text.data() + i + 1, text.size() - i - 1);
    if (rest.find_first_of(".eE") != std::string_view::npos || !parse(rest, exponent)) return false;
    scale += static_cast<int>(exponent);
    i = text.size();
  }
  if (i != text.size() || scale > 30 || scale < -45) return false;
  for (; scale > 0; --scale) number *= 10.0f;
  for (; scale < 0; ++scale) number /= 10.0f;
  value = negative ? -number : number;
  return true;
}

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
  ~Line() {
    text("\r\n");
    serial::put({text_.data(), length_});  // no room: the asker has to ask again
  }

 private:
  std::array<char, 96> text_{};
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

void answer(bool good) {
  Line().text(good ? "ok" : "refused");
}

bool set_parameter(const Words& words, Core& core, Settings& settings) {
  float value = 0.0f;
  if (!parse(words.second, value)) return false;
  for (const Parameter& parameter : kParameters) {
    if (parameter.name != words.first) continue;
    Calibration changed = settings.calibration;
    parameter.in(changed) = value;
    if (!core.recalibrate(changed)) return false;
    settings.calibration = changed;
    return true;
  }
  return false;
}

}  // namespace

void execute(std::string_view text, Core& core, Settings& settings) {
  const Words words = split(text);
  float value = 0.0f;
  const bool number = parse(words.first, value);
  for (const ModeWord& mode : kModes) {
    if (mode.verb == words.verb)
      return answer(number && core.command(mode.mode, mode.scale * value));
  }
  if (words.verb == "status") return report_status(core);
  if (words.verb == "stop") return core.on_setpoint(0), answer(true);
  if (words.verb == "arm") return core.arm_by_hand(), answer(core.supervisor().armed());
  if (words.verb == "set") return answer(set_parameter(words, core, settings));
  if (words.verb == "watch" && number) return core.watch(value != 0.0f), answer(true);
  if (words.verb == "mode" && number) {
    const bool taken = value >= 0.0f && value <= 5.0f &&
                       core.set_mode(static_cast<Mode>(static_cast<std::uint8_t>(value)));
    settings.calibration.mode = core.mode();
    return answer(taken);
  }
  if (words.verb == "motor" && number) {
    const bool valid = value >= 1.0f && value <= 4.0f;
    if (valid) settings.motor_number = static_cast<std::uint32_t>(value);
    return answer(valid);  // the address changes at the next power-up
  }
  if (words.verb == "identified" && number) {
    Calibration changed = settings.calibration;
    changed.identified = value != 0.0f;
    const bool taken = core.recalibrate(changed);
    if (taken) settings.calibration = changed;
    return answer(taken);
  }
  if (words.verb == "save") return answer(core.at_rest() && settings::save(settings));
  Line().text(
      "unknown: duty rpm thrust power st | arm stop status mode set watch motor identified save");
}

}  // namespace fw::esc
