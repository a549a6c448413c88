// What the compiler calls for divisions and comparisons of floats comes here: the linker is told to
// (--wrap=__aeabi_fdiv and so on; Run-time ABI for the Arm Architecture, section 4.1.2).
#include <bit>

#include "firmware/esc/core/float_division.hpp"
#include "firmware/esc/core/float_order.hpp"

namespace {

std::uint32_t bits(float x) {
  return std::bit_cast<std::uint32_t>(x);
}

}  // namespace

extern "C" {
float __real___aeabi_fdiv(float a, float b);

__attribute__((used)) float __wrap___aeabi_fdiv(float a, float b) {
  const fw::esc::Quotient q = fw::esc::quotient(bits(a), bits(b));
  return q.valid ? std::bit_cast<float>(q.bits) : __real___aeabi_fdiv(a, b);
}

__attribute__((used)) int __wrap___aeabi_fcmplt(float a, float b) {
  return fw::esc::is_less(bits(a), bits(b)) ? 1 : 0;
}

__attribute__((used)) int __wrap___aeabi_fcmpgt(float a, float b) {
  return fw::esc::is_less(bits(b), bits(a)) ? 1 : 0;
}

__attribute__((used)) int __wrap___aeabi_fcmple(float a, float b) {
  return fw::esc::is_at_most(bits(a), bits(b)) ? 1 : 0;
}

__attribute__((used)) int __wrap___aeabi_fcmpge(float a, float b) {
  return fw::esc::is_at_most(bits(b), bits(a)) ? 1 : 0;
}
}
