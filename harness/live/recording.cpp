#include "harness/live/recording.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/output_file.hpp"
#include "base/whole_file.hpp"

namespace whirl::live {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestFile_B = 1u << 19;

std::string seconds(std::int64_t ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%lld.%03lld", static_cast<long long>(ns / 1'000'000'000),
                static_cast<long long>(ns / 1'000'000 % 1000));
  return text;
}

std::string hex(const std::vector<std::uint8_t>& bytes) {
  std::string text;
  char digits[3];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

std::string as_command(const std::vector<std::uint8_t>& piece) {
  return "radio = \"" + hex(piece) + "\"";
}

// Travel in tenths of a percent, as a stick is read.
std::string as_command(const request::Sticks& sticks) {
  std::string text = "rc = { ";
  const auto add = [&](const char* name, const std::optional<double>& share) {
    char value[48];
    std::snprintf(value, sizeof value, "%s = \"%.1f %%\", ", name, 100.0 * share.value_or(0.0));
    if (share) text += value;
  };
  add("roll", sticks.roll);
  add("pitch", sticks.pitch);
  add("yaw", sticks.yaw);
  add("thrust", sticks.thrust);
  if (sticks.mode) text += "mode = " + std::to_string(*sticks.mode) + ", ";
  if (sticks.arm) text += std::string("arm = ") + (*sticks.arm ? "true, " : "false, ");
  return text + "on = " + (sticks.transmitter_on ? "true" : "false") + " }";
}

// A Lua text that stands for these bytes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  char code[5];
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= ' ') {
      out += c;
      continue;
    }
    std::snprintf(code, sizeof code, "\\%03d", static_cast<unsigned char>(c));
    out += code;
  }
  return out + "\"";
}

// One line for a comment.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return text;
}

bool is_taken(const FlownPlan& flown, const std::string& name) {
  return std::find(flown.taken_in.begin(), flown.taken_in.end(), name) != flown.taken_in.end();
}

// "commands_1.lua", or the next number that no file of the plan has.
std::string free_name(const FlownPlan& flown, const std::string& stem, int& number) {
  std::string name;
  do {
    name = stem + "_" + std::to_string(++number) + ".lua";
  } while (is_taken(flown, name));
  return name;
}

Result<Done> copy(const std::string& from, const std::string& to) {
  const auto text = read_whole_file(from);
  if (!text) return text.error();
  std::error_code status;
  fs::create_directories(fs::path(to).parent_path(), status);
  return write_text(to, text.value());
}

// The fields that take the place of what the plan says. Their paths lead through plain names.
std::string fields(const FlownPlan& flown) {
  std::string text;
  for (const auto& [key, value] : flown.settings) {
    text += "flown." + key + " = " + quoted(value) + "\n";
  }
  text += "flown.seed = " + std::to_string(flown.seed) + "\n";
  text += "flown.timeout = \"" + seconds(flown.end_ns + 1'000'000'000) + " s\"\n";
  return text + "flown.tags = {}\n";
}

std::string ends(const FlownPlan& flown) {
  std::string text;
  char line[200];
  for (const auto& [signal, value_m] : flown.end_m) {
    std::snprintf(
        line, sizeof line,
        "  t:expect(t:value \"%s\", \"%s at the end, as flown\"):within(\"%.4f m\", \"%.4f m\")\n",
        signal.c_str(), signal.c_str(), value_m - 0.001, value_m + 0.001);
    text += line;
  }
  return text;
}

}  // namespace

void Recording::add(std::int64_t t_ns, std::span<const std::uint8_t> piece) {
  entries_.push_back({t_ns, std::vector<std::uint8_t>(piece.begin(), piece.end())});
  ++pieces_;
}

void Recording::add(std::int64_t t_ns, const request::Sticks& sticks) {
  entries_.push_back({t_ns, sticks});
}

Result<Done> Recording::write(const std::string& folder, const FlownPlan& flown) const {
  const std::string from = fs::absolute(flown.file).parent_path().string() + "/";
  int number = 0;
  const std::string base = free_name(flown, "flown_plan", number);
  if (const auto done = copy(flown.file, folder + "/" + base); !done) return done;
  for (const std::string& name : flown.taken_in) {
    if (const auto done = copy(from + name, folder + "/" + name); !done) return done;
  }
  std::string includes;
  number = 0;
  for (std::size_t i = 0; i < entries_.size();) {
    std::string text = "return function(t)\n";
    for (; i < entries_.size() && text.size() < kLongestFile_B; ++i) {
      const auto& [t_ns, what] = entries_[i];
      text += "t:at(\"" + seconds(t_ns) + " s\", { " +
              std::visit([](const auto& one) { return as_command(one); }, what) + " })\n";
    }
    const std::string name = free_name(flown, "commands", number);
    if (const auto done = write_text(folder + "/" + name, text + "end\n"); !done) return done;
    includes += "  include \"" + name + "\"(t)\n";
  }
  return write_text(
      folder + "/commands.lua",
      "-- What a MAVLink client sent in a flight of " + one_line(flown.file) +
          ", at the same virtual times again: whirl run commands.lua\n"
          "-- Same images, same seed: the digest is that of the flight.\n"
          "local declare, flown = plan, nil\n"
          "function plan(name) return function(p) if name == " +
          quoted(flown.name) + " then flown = p end end end\ninclude \"" + base +
          "\"\nplan = declare\n" + fields(flown) +
          "local run = flown.run\n"
          "function flown.run(t)\n" +
          includes + "  run(t)\n  local left_s = " + seconds(flown.end_ns) +
          " - t:now().value\n"
          "  if left_s > 0.0005 then t:wait(string.format(\"%.3f s\", left_s)) end\n" +
          ends(flown) + "end\nplan(" + quoted(flown.name + ", flown again") + ")(flown)\n");
}

}  // namespace whirl::live
