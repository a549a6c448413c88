// A propeller of one's own, from a file anywhere: no recompilation, and one sentence per fault.
#include "harness/catalogue/propeller_file.hpp"

#include <filesystem>
#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "plant/rotor/twist_fit.hpp"

namespace whirl::catalogue {
namespace {

// APC slow fly 10x7; geometry of [UiucProp].
constexpr const char* kStations = R"(stations = {
    { r = 0.15, c = 0.109, beta = 34.86 }, { r = 0.25, c = 0.155, beta = 36.15 },
    { r = 0.35, c = 0.192, beta = 31.25 }, { r = 0.45, c = 0.216, beta = 25.60 },
    { r = 0.55, c = 0.225, beta = 20.49 }, { r = 0.65, c = 0.219, beta = 17.14 },
    { r = 0.75, c = 0.197, beta = 14.38 }, { r = 0.85, c = 0.159, beta = 11.83 },
    { r = 0.95, c = 0.092, beta = 9.53 },  { r = 1.00, c = 0.049, beta = 8.43 },
  },)";

class PropellerFile : public testing::Test {
 protected:
  Result<std::shared_ptr<const plant::Blade>> read(const std::string& more,
                                                   const std::string& mass = "9 g",
                                                   const char* stations = kStations) {
    const ScratchFolder folder;
    const std::string path = folder.file("my_prop.lua");
    std::ofstream(path) << "return { kind = \"propeller\", name = \"mine\", blades = 2, diameter = "
                           "\"10 in\", mass = \""
                        << mass << "\",\n"
                        << more << "\n"
                        << stations << " }\n";
    return read_propeller(path);
  }
  std::string fault(const std::string& more) {
    const auto blade = read(more);
    if (blade.ok()) return "accepted";
    const std::string text = blade.error().message();
    return text.substr(text.find("my_prop.lua"));
  }
};

// Measured at 6006 rpm, J 0.191: CT 0.1453, CP 0.0799 [UiucProp]. No thrust at rest is at hand for it: the
// blades known that are like it say what it does, with the twist that photographs lack.
TEST_F(PropellerFile, WithoutPolarsBladesLikeItSayWhatItDoes) {
  const auto prop = read("tip_twist_correction = \"3 deg\",");
  ASSERT_TRUE(prop.ok()) << prop.error().message();
  const auto k = plant::propeller_coefficients(prop.value(), 6006 * 0.10471975512, 0.191);
  EXPECT_TRUE(near(k.CT, 0.1453, stated(0.1453 * 0.10, "10 % asked of flight")));
  EXPECT_TRUE(near(k.CP, 0.0799, stated(0.0799 * 0.12, "12 % asked of flight")));
}

// 0.161 rho n2 D4 at 6000 rpm and 10 in.
TEST_F(PropellerFile, NewtonsAndWattsSayWhatCoefficientsSay) {
  const auto coefficients = read("static = { { rpm = 6000, CT = 0.161, CP = 0.080 } },");
  const auto newtons = read(
      "static = { { rpm = 6000, thrust = \"7.53564 N\", power = \"95.1082 W\" } }, density = "
      "\"1.1245 kg/m3\",");
  ASSERT_TRUE(newtons.ok()) << newtons.error().message();
  EXPECT_TRUE(near(plant::propeller_coefficients(newtons.value(), 600.0, 0.3).CT,
                   plant::propeller_coefficients(coefficients.value(), 600.0, 0.3).CT,
                   stated(1e-4, "five digits")));
}

// Two rows that contradict what blades of this shape do: the fit moves towards each, and only as far as its trust.
TEST_F(PropellerFile, ARowInFlightMovesTheBladeTowardsIt) {
  const std::string still = "static = { { rpm = 6000, CT = 0.161, CP = 0.080 } },";
  const auto at = [](const auto& prop) {
    return plant::propeller_coefficients(prop.value(), 628.3185, 0.4).CT;
  };
  const double alone = at(read(still));
  for (const double share : {0.9, 1.1}) {
    const auto prop =
        read(still + "flight = { { rpm = 6000, J = 0.4, CT = " + std::to_string(share * alone) +
             " } },");
    ASSERT_TRUE(prop.ok()) << prop.error().message();
    EXPECT_GT((at(prop) / alone - 1.0) / (share - 1.0), 0.4) << share;
    EXPECT_LT((at(prop) / alone - 1.0) / (share - 1.0), 1.05) << share;
  }
}

TEST_F(PropellerFile, DoubtsOfNamedPolarsAreThoseOfStaticRows) {
  const ScratchFolder folder;
  const auto doubts = [&](const char* CP) {
    std::ofstream(folder.file("p.lua"))
        << "return { kind = \"propeller\", name = \"mine\", blades = 2, diameter = \"10 in\", mass "
           "= "
           "\"9 g\", polars = { { r = 0.2, file = \"bw3.polar\" }, { r = 0.9, file = \"e63.polar\" "
           "} }, static = { { rpm = 6000, CT = 0.14, CP = "
        << CP << " } }, " << kStations << " }\n";
    const auto read = read_propeller_file(folder.file("p.lua"));
    EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().message());
    return read.ok() ? read.value().doubts() : std::vector<std::string>{};
  };
  std::string all;
  for (const std::string& doubt : doubts("0.12")) all += doubt + "\n";
  EXPECT_NE(all.find("mine: static power is left over by"), std::string::npos) << all;
}

TEST_F(PropellerFile, SlipsOfThePenAreRefused) {
  EXPECT_NE(fault("flight = { { rpm = 6000, CT = 0.1 } },").find("J"), std::string::npos);
  EXPECT_NE(fault("flight = { { rpm = 6000, J = 0, CT = 0.1 } },").find("J"), std::string::npos);
  EXPECT_NE(fault("flight = { { rpm = 6000, J = 0.4, CT = 0.1 } }, polars = { { r = 0, file = "
                  "\"e63.polar\" } },")
                .find("goes without polars"),
            std::string::npos);
  for (const char* line : {"material = \"nylon\",", "thickness = 0.08,", "induced_factor = 1.1,",
                           "stall_delay = false,"}) {
    EXPECT_NE(fault(line).find("goes with polars"), std::string::npos) << line;
  }
  // sqrt(2 / pi) 0.161^(3/2) = 0.0515; 1 W instead of 95. J CT = 0.0564.
  EXPECT_NE(fault("static = { { rpm = 6000, CT = 0.161, CP = 0.051 } },").find("an ideal rotor"),
            std::string::npos);
  EXPECT_EQ(fault("static = { { rpm = 6000, CT = 0.161, CP = 0.08 }, { rpm = 6000, thrust = "
                  "\"7.5 N\", power = \"1 W\" } },"),
            "my_prop.lua:2: static[2].power: is less than an ideal rotor takes for that thrust "
            "(check its unit, the density and the diameter; power is that of the shaft)");
  EXPECT_NE(fault("static = { { rpm = 6000, CT = 0.161, CP = 0.08 } }, flight = { { rpm = 6000, J "
                  "= 0.4, CT = 0.141, CP = 0.056 } },")
                .find("an efficiency above 1"),
            std::string::npos);
  EXPECT_NE(fault("static = { { rpm = 6000, CT = 0.161 } }, tip_twist_correction = \"2 deg\",")
                .find("does not go with static"),
            std::string::npos);
  EXPECT_NE(read("", "9 kg").error().message().find("over twenty times"), std::string::npos);
  const auto radians =
      read("", "9 g",
           "stations = { { r = 0.2, c = 0.1, beta = 0.4 }, { r = 0.6, c = 0.1, beta "
           "= 0.2 }, { r = 1, c = 0.05, beta = 0.1 } },");
  ASSERT_FALSE(radians.ok());
  EXPECT_NE(radians.error().message().find("look like radians"), std::string::npos);
}

TEST_F(PropellerFile, FaultsAreNamedWithTheirPlace) {
  EXPECT_EQ(
      fault("polars = { { r = 0.2, file = \"bw3.polar\" } }, material = \"cheese\","),
      "my_prop.lua:2: material: 'cheese' is not known (use one of carbon, glass nylon, nylon, "
      "rigid, wood)");
  EXPECT_EQ(
      fault("polars = { { r = 0.2, file = \"nix.polar\" } },"),
      "my_prop.lua: polar 'nix.polar' is nowhere to be found (put it beside this file, or name "
      "one of plant/data/polars)");
  EXPECT_NE(fault("pitch = 7,").find("my_prop.lua:2: unknown key 'pitch'"), std::string::npos);
  EXPECT_NE(
      fault("static = { { rpm = 5000, CT = 0.9 } },").find("my_prop.lua: no blade of this shape"),
      std::string::npos);
}

}  // namespace
}  // namespace whirl::catalogue
