#pragma once
#include <string>

namespace palpate {

/// A box of 2 x 3 x 5 as Collada has it: the geometry "g", on nodes as given.
inline std::string collada(const std::string& unit,
                           const std::string& nodes = "<node><instance_geometry url='#g'/></node>",
                           const std::string& controllers = "") {
    return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
           "version='1.4.1'><asset>" +
           unit +
           "<up_axis>Y_UP</up_axis></asset><library_geometries><geometry id='g'><mesh><source "
           "id='s'><float_array "
           "id='a' count='24'>0 0 0 2 0 0 0 3 0 2 3 0 0 0 5 2 0 5 0 3 5 2 3 "
           "5</float_array><technique_common><accessor "
           "source='#a' count='8' stride='3'><param name='X' type='float'/><param name='Y' "
           "type='float'/><param "
           "name='Z' type='float'/></accessor></technique_common></source><vertices id='v'><input "
           "semantic='POSITION' source='#s'/></vertices><triangles count='12'><input semantic='VERTEX' "
           "source='#v' offset='0'/><p>0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 "
           "5</p>"
           "</triangles></mesh></geometry></library_geometries>" +
           controllers + "<library_visual_scenes><visual_scene id='w'>" + nodes +
           "</visual_scene></library_visual_scenes><scene><instance_visual_scene "
           "url='#w'/></scene></COLLADA>";
}

}  // namespace palpate
