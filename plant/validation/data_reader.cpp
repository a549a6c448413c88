#include "plant/validation/data_reader.hpp"

#include <map>

namespace whirl::plant {

SectionOf section_reader(ReadData read) {
  auto known = std::make_shared<std::map<std::string, std::shared_ptr<const PolarFamily>>>();
  return [known, read = std::move(read)](const std::string& name) {
    auto& entry = (*known)[name];
    if (entry == nullptr) {
      const std::string path = "polars/" + name + ".polar";
      entry = std::make_shared<PolarFamily>(read_polar(read(path), path).value());
    }
    return entry;
  };
}

}  // namespace whirl::plant
