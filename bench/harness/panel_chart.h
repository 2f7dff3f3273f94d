#pragma once
// Small multiples: panels of lines in rows and columns, drawn by gnuplot.

#include <string>
#include <vector>

#include "bench/harness/gnuplot.h"

namespace obscura {

struct PanelPoint {
    double x, y;
};

/// One line: a method in a panel.
struct PanelLine {
    std::string method;
    std::vector<PanelPoint> points;
    bool hollow = false;    ///< hollow points
    bool plain = false;     ///< a line without points
    std::string name = {};  ///< in the key; empty: the method
};

struct Panel {
    std::string title;
    std::string y_label;  ///< empty: the chart's, on panels of the first column
    std::vector<PanelLine> lines;
};

/// Panels row by row, both axes logarithmic.
struct PanelChart {
    MethodStyle (*style_of)(const std::string& method) = nullptr;
    std::string title, note, x_label, y_label;
    std::string x_tics;  ///< gnuplot commands for the axis
    std::vector<Panel> panels;
    std::string key = "bottom left";  ///< the corner that curves leave free
    int columns = 3;                  ///< at most
    int panel_height = 290;           ///< pixels
    bool key_strip = false;           ///< one key above all panels, a line per method; none in them
    double key_height = 46;           ///< of the strip, pixels
    bool one_key = false;             ///< keys on the first row alone, and x labels on the last
};

/// The script that draws it, for run_gnuplot().
std::string panel_script(const PanelChart& chart);

}  // namespace obscura
