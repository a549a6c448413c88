#include "base/places.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace whirl {
namespace {

TEST(Places, AProgramKnowsItsOwnFile) {
  const std::filesystem::path own = own_program();
  EXPECT_TRUE(own.is_absolute());
  EXPECT_EQ(own.filename(), "base_test");
  EXPECT_TRUE(std::filesystem::exists(own));
}

}  // namespace
}  // namespace whirl
