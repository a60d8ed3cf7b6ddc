// How time and error of a technique grow with one parameter, from a report's rows.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace gnomon {

// "sweeps" of report_data(). `places`: of each row what is the same for all that can be compared with it;
// `metrics`: of the report.
nlohmann::json sweeps_of(const nlohmann::json& rows, const std::vector<nlohmann::json>& places,
                         const nlohmann::json& metrics);

}  // namespace gnomon
