// The thesis's propeller: static thrust, figure of merit, thrust under a downdraft, CT against CP.
//
//   Not used   the thesis's torque and power figures: they put the figure of merit above 1.
//   Source     [Bangura2017, 3.5 and Table 5.6]; the bounds on the downdraft's slope are those of the
//              four measured slow flyers at the same advance ratio.
#pragma once
#include "plant/validation/data_reader.hpp"
#include "plant/validation/report.hpp"

namespace whirl::plant {

Report validate_hobbyking(const ReadData& read);

}  // namespace whirl::plant
