// The panel beside the picture, by Dear ImGui.
#pragma once

#include "apps/viewer/controls.hpp"
#include "apps/viewer/viewer.hpp"

#include <string>

namespace halflit::viewer {

/// Texts that the panel shows.
struct PanelTexts {
    std::string scene;   ///< its name and number of triangles
    std::string status;  ///< times of the picture
    std::string error;   ///< of the last picture; empty: none
    std::string view;    ///< flags of the view; empty: that of the start
    float exposure = 1;  ///< factor on all light without the control's
    std::string plan, report, pixel;
    bool marked = false;  ///< the pixel that is told about is in view
    int mark_x = 0, mark_y = 0;
};

struct Panel {
    Controls controls;       ///< as the user left them
    const Controls started;  ///< those of the flags
    bool has_own_lobes;      ///< some material of the scene chose its lobe
    Tab tab = Tab::plan;
    bool select_tab = true;   ///< bring `tab` to the front
    bool reset_view = false;  ///< the button was pressed

    /// Draws it into the window's right part. True if a control changed.
    bool draw(const PanelTexts& texts, int left, int width, int height);
};

}  // namespace halflit::viewer
