// frame_files.h — the names of the pictures of an animation
// What       "f_####.png" is f_0007.png for frame 7: the run of # in the file's name is replaced by the number, padded
//            with zeros to its length, sign included; longer numbers take more room
#pragma once

#include <string>

namespace arris::program {

// Empty if the name has one run of #; else what is wrong with it and what to do.
std::string problem_with_pattern(const std::string& pattern);

// Precondition: there is no problem with the pattern.
std::string frame_file(const std::string& pattern, int frame);

}  // namespace arris::program
