// What one number of a part may be from copy to copy, and the draw of one copy's.
//
//   Laws     normal: sigma about the middle, cut off at the limit, which is what the data sheet guarantees;
//            even: anywhere within the limit (sorted resistors); level: evenly within sigma of the middle,
//            for what is bad one way only (noise, series resistance)
//   Worst    at the limit: to either side, a coin per number; of a level: the middle and the limit on top
//   Streams  each number has its own, named by its owner and itself: one more disturbs no other
//   Error    moments and limits of the draws (tests/spread_test.cpp)
//   Left out that numbers hang together (two resistors of one reel, wire resistance and turns)
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace whirl::plant {

enum class ToleranceClass : std::uint8_t {
  none,     // the drawing's own number
  typical,  // a copy out of the bag
  worst,    // every number at its limit
};

const char* name(ToleranceClass tolerance);
std::optional<ToleranceClass> tolerance_named(std::string_view word);

struct Spread {
  enum class Law : std::uint8_t { normal, even, level };
  Law law = Law::normal;
  double middle = 0.0, sigma = 0.0, limit = 0.0;  // sigma of a level: half its usual width
};

// Pre: tolerance is not none.
double draw(const Spread& spread, ToleranceClass tolerance, std::uint64_t seed,
            const std::string& stream);

// Between what every draw lies. Pre: tolerance is not none.
struct DrawRange {
  double low, high;
};
DrawRange bounds(const Spread& spread, ToleranceClass tolerance);

}  // namespace whirl::plant
