#include "firmware/link/parameter_link.hpp"

#include <algorithm>

namespace fw {
namespace {

using mavlink::for_us, mavlink::Frame, mavlink::Message;

constexpr std::uint8_t kReal32 = 9;  // MAV_PARAM_TYPE
constexpr std::size_t kNameLength = 16;

std::optional<std::size_t> index_named(const Frame& frame, std::size_t offset) {
  const auto name = frame.get<std::array<char, kNameLength>>(offset);
  const auto end = std::find(name.begin(), name.end(), '\0');
  return Parameters::index_of({name.data(), static_cast<std::size_t>(end - name.begin())});
}

}  // namespace

void ParameterLink::on_frame(const Frame& frame, Parameters& parameters, bool armed) {
  if (frame.id == mavlink::kParamRequestRead && for_us(frame, 2)) on_read(frame);
  if (frame.id == mavlink::kParamRequestList && for_us(frame, 0)) listed_ = 0;
  if (frame.id == mavlink::kParamSet && for_us(frame, 4)) on_set(frame, parameters, armed);
}

void ParameterLink::on_read(const Frame& frame) {
  const auto number = frame.get<std::int16_t>(0);
  std::optional<std::size_t> index;
  if (number == -1) {
    index = index_named(frame, 4);
  } else if (number >= 0 && static_cast<std::size_t>(number) < kParameterCount) {
    index = static_cast<std::size_t>(number);
  }
  if (index) asked_[*index] = true;
}

void ParameterLink::on_set(const Frame& frame, Parameters& parameters, bool armed) {
  const auto index = index_named(frame, 6);
  if (!index) return;
  asked_[*index] = true;
  if (frame.get<std::uint8_t>(22) != kReal32) return;
  parameters.set(*index, frame.get<float>(0), armed);
}

std::optional<std::size_t> ParameterLink::due_index() const {
  for (std::size_t i = 0; i < kParameterCount; ++i) {
    if (asked_[i]) return i;
  }
  if (listed_ < kParameterCount) return listed_;
  return std::nullopt;
}

Message ParameterLink::next(const Parameters& parameters) {
  const std::size_t index = *due_index();
  if (asked_[index]) {
    asked_[index] = false;
  } else {
    ++listed_;
  }
  const ParameterRow& row = kParameterTable[index];
  Message m(mavlink::kParamValue, 25);
  m.put(0, parameters.value(index)).put(4, static_cast<std::uint16_t>(kParameterCount));
  m.put(6, static_cast<std::uint16_t>(index)).put(24, kReal32);
  for (std::size_t i = 0; i < row.name.size(); ++i) m.put(8 + i, row.name[i]);
  return m;
}

}  // namespace fw
