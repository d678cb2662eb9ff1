// What the robot does and why, in words: the sentence that every page opens with, and the facts below it. First person,
// present tense; one entry a language ("en", "de").
#pragma once

#include "robot/museum.hpp"
#include "robot/outputs.hpp"

namespace robot {

// "I am on my way to the beam engine."
Text status_sentence(const Status& status, const Museum& museum);

// "For Mirela. 14 m to go, about 40 s." Empty texts when there is nothing to add.
Text status_detail(const Status& status, const Museum& museum);

// A duration as people say it: "about 40 s", "4 min".
Text spoken_duration(double seconds);

}  // namespace robot
