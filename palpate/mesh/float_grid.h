#pragma once
#include <openvdb/openvdb.h>

// The library holds these compiled. Without a word of it, each file that makes a grid would compile them
// again.
extern template class openvdb::Grid<openvdb::FloatTree>;
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
