// What a target can do beside running an image: a plan that asks for more is refused before it starts.
#pragma once
#include <cstdint>
#include <initializer_list>

namespace whirl {

enum class Offer : std::uint8_t {
  virtual_time = 1,  // it waits for the harness, whatever that does; digests repeat
  watches = 2,       // functions and the core's load are timed, the depth of stacks is told
  wire_faults = 4,   // buses and devices can be spoilt
  bus_log = 8,       // each transaction is told, with its times
};

class Offers {
 public:
  constexpr Offers() = default;
  constexpr Offers(std::initializer_list<Offer> all) {
    for (const Offer offer : all) bits_ |= static_cast<unsigned>(offer);
  }
  constexpr bool has(Offer offer) const { return (bits_ & static_cast<unsigned>(offer)) != 0; }
  constexpr Offers operator&(Offers other) const {  // what both can
    other.bits_ &= bits_;
    return other;
  }

 private:
  unsigned bits_ = 0;
};

inline constexpr Offers kAll_offers{Offer::virtual_time, Offer::watches, Offer::wire_faults,
                                    Offer::bus_log};

inline const char* name(Offer offer) {
  switch (offer) {
    case Offer::virtual_time:
      return "virtual time";
    case Offer::watches:
      return "watches of functions, of stacks and of the core's load";
    case Offer::wire_faults:
      return "faults on wires and devices";
    case Offer::bus_log:
      return "a log of its buses";
  }
  return "?";
}

}  // namespace whirl
