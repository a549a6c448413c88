#include "harness/calibrate/data_file.hpp"

#include <array>
#include <cstdio>
#include <sstream>

#include "base/whole_file.hpp"

namespace whirl::calibrate {
namespace {

template <typename T>
using Member = double T::*;

constexpr std::array<Member<SteadyPoint>, 10> kSteady = {
    &SteadyPoint::wind_mps,        &SteadyPoint::duty,     &SteadyPoint::speed_radps,
    &SteadyPoint::esc_A,           &SteadyPoint::esc_V,    &SteadyPoint::meter_A,
    &SteadyPoint::meter_V,         &SteadyPoint::thrust_N, &SteadyPoint::torque_Nm,
    &SteadyPoint::esc_A_half_width};
constexpr std::array<Member<Sample>, 5> kSample = {
    &Sample::t_s, &Sample::duty, &Sample::speed_radps, &Sample::bus_A, &Sample::bus_V};

struct SteadyList {
  const char* name;
  std::vector<SteadyPoint> StandData::*list;
};
struct SampleList {
  const char* name;
  std::vector<Sample> StandData::*list;
};
constexpr SteadyList kSteady_lists[] = {{"rest", &StandData::rest},
                                        {"still", &StandData::still},
                                        {"blown", &StandData::blown},
                                        {"zero", &StandData::zero},
                                        {"updraft", &StandData::updraft}};
constexpr SampleList kSample_lists[] = {{"steps", &StandData::steps},
                                        {"sinusoid", &StandData::sinusoid}};

template <typename T, std::size_t n>
void write(std::string& text, const char* name, const std::vector<T>& list,
           const std::array<Member<T>, n>& members) {
  char number[40];
  for (const T& point : list) {
    text += name;
    for (const Member<T> member : members) {
      std::snprintf(number, sizeof number, " %.17g", point.*member);
      text += number;
    }
    text += "\n";
  }
}

template <typename T, std::size_t n>
bool read(std::istream& in, std::vector<T>& list, const std::array<Member<T>, n>& members) {
  T point;
  for (const Member<T> member : members) {
    if (!(in >> point.*member)) return false;
  }
  list.push_back(point);
  return true;
}

bool read_line(const std::string& word, std::istream& in, StandData& data) {
  if (word == "radius") return static_cast<bool>(in >> data.radius_m);
  if (word == "density") return static_cast<bool>(in >> data.density_kgpm3);
  for (const SteadyList& l : kSteady_lists) {
    if (word == l.name) return read(in, data.*(l.list), kSteady);
  }
  for (const SampleList& l : kSample_lists) {
    if (word == l.name) return read(in, data.*(l.list), kSample);
  }
  return false;
}

}  // namespace

std::string data_text(const StandData& data) {
  char text[120];
  std::snprintf(text, sizeof text, "radius %.17g\ndensity %.17g\n", data.radius_m,
                data.density_kgpm3);
  std::string all =
      "# list wind_mps duty speed_radps esc_A esc_V meter_A meter_V thrust_N torque_Nm\n"
      "# esc_A_half_width; steps and sinusoid: t_s duty speed_radps bus_A bus_V\n";
  all += text;
  for (const SteadyList& l : kSteady_lists) write(all, l.name, data.*(l.list), kSteady);
  for (const SampleList& l : kSample_lists) write(all, l.name, data.*(l.list), kSample);
  return all;
}

Result<StandData> read_data(const std::string& path) {
  const auto whole = read_whole_file(path);
  if (!whole) return whole.error();
  std::istringstream file(whole.value());
  StandData data;
  int number = 0;
  for (std::string text; std::getline(file, text);) {
    ++number;
    std::istringstream in(text);
    std::string word, rest;
    if (!(in >> word) || word[0] == '#') continue;
    if (read_line(word, in, data) && !(in >> rest)) continue;
    return Error{ErrorKind::bad_input, path + ":" + std::to_string(number),
                 "'" + word + "' is no list of a stand's data, or has not as many numbers", ""};
  }
  return data;
}

}  // namespace whirl::calibrate
