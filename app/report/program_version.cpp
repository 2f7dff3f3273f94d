#include "app/report/program_version.h"

namespace obscura {

std::string program_version() {
    return "obscura " OBSCURA_VERSION;
}

}  // namespace obscura
