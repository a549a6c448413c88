// What `whirl sweep` and `whirl validate` of a file refuse, with one sentence that says what to give instead.
#include "harness/tests/plans.hpp"

namespace whirl::test {
namespace {

TEST(SweepCommand, RefusesWhatItCannotRead) {
  FakeRoot root;
  root.write("neither.lua", "return { kind = \"boat\" }");
  const std::string file = root.path() + "/neither.lua";
  EXPECT_EQ(whirl(root, {"sweep", "nowhere.lua"}).code, 2);
  EXPECT_NE(whirl(root, {"sweep", file}).err.find("is no propeller, motor, stand or vehicle"),
            std::string::npos);
  root.write("pack.lua", "return { kind = \"battery\" }");
  const std::string pack = root.path() + "/pack.lua";
  for (const std::vector<std::string>& words : {std::vector<std::string>{"sweep", pack},
                                                {"validate", pack, file},
                                                {"sweep", pack, "--seeds", "1..3"}}) {
    EXPECT_NE(whirl(root, words).err.find("is a battery"), std::string::npos) << words[0];
  }
  root.write("quad.lua", "return { kind = \"vehicle\" }");
  const std::string quad = root.path() + "/quad.lua";
  EXPECT_NE(whirl(root, {"sweep", quad, "--J", "0.1"}).err.find("--J: " + quad + " is a vehicle"),
            std::string::npos);
  EXPECT_NE(whirl(root, {"sweep", file, "--J", "0.1,nan"}).err.find("--J: nan is outside 0 to 2"),
            std::string::npos);
  EXPECT_NE(
      whirl(root, {"sweep", file, "--speeds", "5 V"}).err.find("--speeds: '5 V' is a voltage"),
      std::string::npos);
  EXPECT_NE(whirl(root, {"sweep", file, "--speed", "5 V"}).err.find("--speed: '5 V' is a voltage"),
            std::string::npos);
  EXPECT_EQ(whirl(root, {"validate"}).code, 2);  // this root has no reference data
}

}  // namespace
}  // namespace whirl::test
