#include "base/mishap.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

namespace whirl {
namespace {

template <typename Thrown>
ErrorKind kind_of(const Thrown& thrown) {
  try {
    throw thrown;
  } catch (...) {
    return error_of_current_exception().kind;
  }
}

// What the system refuses is the host's, be it memory, a file or a read of one.
TEST(Mishap, WhatTheSystemRefusesIsTheHostsAndAllElseIsOurs) {
  EXPECT_EQ(kind_of(std::bad_alloc()), ErrorKind::host);
  EXPECT_EQ(kind_of(std::filesystem::filesystem_error("x", std::error_code())), ErrorKind::host);
  const std::error_code error(EIO, std::generic_category());
  EXPECT_EQ(kind_of(std::ios_base::failure("read", error)), ErrorKind::host);
  EXPECT_EQ(kind_of(std::system_error(error)), ErrorKind::host);
  EXPECT_EQ(kind_of(std::logic_error("ours")), ErrorKind::internal);
}

}  // namespace
}  // namespace whirl
