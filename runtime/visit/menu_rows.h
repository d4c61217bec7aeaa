// What stands on the visitor's pages and what pressing it does. Knows nothing of how they look.
#pragma once
#include <string>

#include "runtime/simulation/simulation.h"
#include "runtime/visit/controls.h"
#include "runtime/visit/menu.h"
#include "runtime/visit/rows.h"

namespace flaneur {

// The rows of the page that is open; none of map and photo. What is pressed counts at once.
MenuChoice FillRows(const Simulation& simulation, Menu* menu, Controls* controls, Rows* rows);
// Over the rows. title: the tour's.
std::string HeadOf(const Menu& menu, const std::string& title, const std::string& language);
// The button below all rows, which leads back; empty: there is none.
std::string BackOf(const Menu& menu, const std::string& language);

}  // namespace flaneur
