// The parameters as a DroneCAN node tells them (dronecan/node.hpp): by their place in the table.
#pragma once
#include "firmware/config/parameters.hpp"

namespace fw {

class ParameterAccess {
 public:
  void join(Parameters& parameters) { parameters_ = &parameters; }
  void set_armed(bool armed) { armed_ = armed; }

  std::size_t count() const { return parameters_ == nullptr ? 0 : kParameterCount; }
  std::string_view name(std::size_t i) const { return kParameterTable[i].name; }
  bool is_whole(std::size_t i) const { return kParameterTable[i].numbers == Numbers::whole; }
  float value(std::size_t i) const { return parameters_->value(i); }
  float start(std::size_t i) const { return kParameterTable[i].start; }
  float low(std::size_t i) const { return kParameterTable[i].low; }
  float high(std::size_t i) const { return kParameterTable[i].high; }
  bool set(std::size_t i, float value) { return parameters_->set(i, value, armed_); }

 private:
  Parameters* parameters_ = nullptr;
  bool armed_ = true;  // until it is known
};

}  // namespace fw
