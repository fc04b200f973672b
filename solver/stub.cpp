#include "solver/equilibrium.hpp"
#include "solver/run.hpp"
