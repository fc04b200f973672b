#include "apps/base/revision.hpp"

#include "myowave_version.hpp"  // written by cmake/Revision.cmake

namespace myowave::apps {

const char* version() { return myowave::version; }
const char* git_revision() { return myowave::git_hash; }
bool has_local_changes() { return myowave::git_dirty; }

}  // namespace myowave::apps
