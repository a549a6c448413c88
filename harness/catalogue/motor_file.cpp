#include "harness/catalogue/motor_file.hpp"

#include "harness/catalogue/motor.hpp"

namespace whirl::catalogue {

Result<MotorFile> read_motor_file(const std::string& path) {
  const auto file = lua::read_file(path);
  if (!file) return file.error();
  const lua::Table& t = file.value();
  std::ignore = t.choice("kind", {"motor"});
  MotorFile motor{t.text("name"), {}};
  if (t.has("file")) t.refuse("file", "a motor's file cannot be another one's");
  motor.params = read_motor(t, MissingKeys::refused);
  if (const auto good = t.finish(); !good) return good.error();
  if (const auto good = plant::validate(motor.params, path); !good) return good.error();
  return motor;
}

}  // namespace whirl::catalogue
