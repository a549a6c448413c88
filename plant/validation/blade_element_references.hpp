// The ring balance against other people's blade-element programs.
//
//   CCBlade a  analytic polar, no losses: thrust within 0.01 N, torque within 0.002 N m of 1000 N, 80 N m
//   CCBlade b  Prandtl tip and hub loss, 0 to full advance ratio: 0.1 %
//   CCBlade c  hover over 40 collectives, no swirl (that program leaves it out there): 1 %
//   QPROP      hover of a 6x3 folding propeller, its own section formulas: 2 %
//   Texts      the files of plant/data/reference, as named
#pragma once
#include "plant/validation/report.hpp"

namespace whirl::plant {

Report validate_ccblade_a(const std::string& ccblade_a);
Report validate_ccblade_b(const std::string& ccblade_b_sections, const std::string& ccblade_b_sweep,
                          const std::string& ccblade_naca64);
Report validate_ccblade_c(const std::string& ccblade_c, const std::string& ccblade_naca0012);
Report validate_qprop(const std::string& qprop_cam6x3);

}  // namespace whirl::plant
