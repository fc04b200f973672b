#include "apps/run_folder.hpp"
