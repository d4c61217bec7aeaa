// What the player itself says to the visitor, in the languages that it knows: English and German.
#pragma once
#include <string>
#include <vector>

#include "runtime/visit/player_settings.h"

namespace flaneur {

enum class Phrase {
  kContinue,
  kBegin,
  kTour,
  kFreeWalk,
  kStops,
  kLanguage,
  kSettings,
  kKeys,
  kEnd,
  kBackToPages,
  kMore,
  kNow,
  kNext,
  kMouse,
  kMouseLooks,
  kMousePoints,
  kWalkSpeed,
  kTurnSpeed,
  kMouseSpeed,
  kFieldOfView,
  kSnapTurn,
  kSmoothly,
  kInvertLook,
  kReducedMotion,
  kVolume,
  kFramesPerSecond,
  kLeastResolution,
  kYes,
  kNo,
  kDecimalPoint,
  kDefaults,
  kAction,
  kKeyboard,
  kGamepad,
  kPressKey,
  kPressButton,
  kNothing,
  kStick,
  kHintKeys,
  kHintTouch,
  kHintLedKeys,
  kHintLedTouch,
  kHintMenu,
  kTourPaused,
  kTourGoesOn,
  kTourLeft,
  kTourOver,
  kNextStop,
  kCornerButton,
  kPinAsked,
  kPinWrong,
  kPinWait,
  kOperator,
  kRestart,
  kTouchToBegin,
  kCount
};

// In English where there is nothing in this language, such as "de" or "de-AT".
const char* Say(Phrase phrase, const std::string& language);
const char* NameOf(Action action, const std::string& language);
// As it stands on a keyboard of that language: "Space", "Leertaste"; those of the keypad as "Num 5".
std::string KeyName(const std::string& label, const std::string& language);

// Of the player's own words.
const std::vector<std::string>& PhraseLanguages();
// In itself, such as "Deutsch" for "de"; the code where it is not known.
std::string LanguageName(const std::string& language);

}  // namespace flaneur
