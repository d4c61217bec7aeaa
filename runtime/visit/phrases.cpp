#include "runtime/visit/phrases.h"

#include <array>
#include <utility>

namespace flaneur {
namespace {

struct Words {
  const char *en, *de;
};

// In the order of Phrase.
constexpr std::array<Words, static_cast<size_t>(Phrase::kCount)> kPhrases{{
    {"Continue", "Weiter"},
    {"Begin", "Beginnen"},
    {"Guided tour", "Führung"},
    {"Walk on your own", "Allein umhergehen"},
    {"Stops of the tour", "Stationen der Führung"},
    {"Language", "Sprache"},
    {"Settings", "Einstellungen"},
    {"Keys", "Tasten"},
    {"End", "Beenden"},
    {"Back", "Zurück"},
    {"More", "Mehr"},
    {"here", "hier"},
    {"next", "als Nächstes"},
    {"Mouse", "Maus"},
    {"looks", "blickt"},
    {"points", "zeigt"},
    {"Walking speed", "Gehtempo"},
    {"Turning speed", "Drehtempo"},
    {"Mouse speed", "Maustempo"},
    {"Field of view", "Blickwinkel"},
    {"Turn in steps of", "Drehen in Schritten"},
    {"smoothly", "fließend"},
    {"Look upside down", "Blick umgekehrt"},
    {"Less motion", "Weniger Bewegung"},
    {"Volume", "Lautstärke"},
    {"Pictures a second", "Bilder je Sekunde"},
    {"Coarsest picture", "Gröbstes Bild"},
    {"yes", "ja"},
    {"no", "nein"},
    {".", ","},
    {"As it was delivered", "Wie ausgeliefert"},
    {"What", "Was"},
    {"Keyboard", "Tastatur"},
    {"Gamepad", "Gamepad"},
    {"press a key", "Taste drücken"},
    {"press a button", "Knopf drücken"},
    {"none", "keine"},
    {"stick", "Stick"},
    {"%s walk, the mouse looks around, a click leads you there.",
     "%s: gehen. Die Maus blickt umher, ein Klick führt dorthin."},
    {"Tap where you want to go, drag to look around.",
     "Tippen Sie an, wohin Sie möchten; ziehen Sie, um sich umzusehen."},
    {"The guided tour leads you. The mouse looks around; %s: walk on your own.",
     "Die Führung geht voran. Die Maus blickt umher; %s: selbst gehen."},
    {"The guided tour leads you. Drag to look around, tap to walk on your own.",
     "Die Führung geht voran. Ziehen Sie, um sich umzusehen, tippen Sie, um selbst zu gehen."},
    {"More: %s", "Mehr: %s"},
    {"The tour waits. %s goes on.", "Die Führung wartet. Weiter: %s"},
    {"The tour goes on.", "Die Führung geht weiter."},
    {"You walk on your own. Back to the tour: %s", "Sie gehen allein umher. Zurück zur Führung: %s"},
    {"The tour is over. Walk about as you like.", "Die Führung ist zu Ende. Gehen Sie umher, wie Sie mögen."},
    {"Next: %s", "Als Nächstes: %s"},
    {"the button in the corner", "der Knopf in der Ecke"},
    {"Operator: PIN", "Personal: PIN"},
    {"Wrong. Again", "Falsch. Noch einmal"},
    {"Wait", "Warten"},
    {"Operator", "Personal"},
    {"Start anew", "Neu starten"},
    {"Touch to begin", "Berühren, um zu beginnen"},
}};

constexpr std::array<Words, kActions> kActionWords{{
    {"Walk ahead", "Vorwärts gehen"},
    {"Walk back", "Rückwärts gehen"},
    {"Step left", "Nach links treten"},
    {"Step right", "Nach rechts treten"},
    {"Turn left", "Nach links drehen"},
    {"Turn right", "Nach rechts drehen"},
    {"Look up", "Nach oben blicken"},
    {"Look down", "Nach unten blicken"},
    {"Tour or own way", "Führung oder allein"},
    {"Hold the tour", "Führung anhalten"},
    {"Next stop", "Nächste Station"},
    {"Stop before", "Vorige Station"},
    {"Language", "Sprache"},
    {"Catch the mouse", "Maus fangen"},
    {"Wider view", "Weiterer Blick"},
    {"Narrower view", "Engerer Blick"},
    {"Plan and figures", "Plan und Zahlen"},
    {"How people keep off", "Wie Leute ausweichen"},
    {"Full screen", "Ganzer Bildschirm"},
    {"These pages", "Diese Seiten"},
    {"End", "Beenden"},
}};

// By their English labels.
constexpr std::pair<const char*, const char*> kGermanKeys[] = {{"Space", "Leertaste"},
                                                               {"Backspace", "Rücktaste"},
                                                               {"Insert", "Einfg"},
                                                               {"Delete", "Entf"},
                                                               {"Home", "Pos1"},
                                                               {"End", "Ende"},
                                                               {"Page Up", "Bild ↑"},
                                                               {"Page Down", "Bild ↓"},
                                                               {"Left Shift", "Umschalt links"},
                                                               {"Right Shift", "Umschalt rechts"},
                                                               {"Left Control", "Strg links"},
                                                               {"Right Control", "Strg rechts"},
                                                               {"Left Alt", "Alt"},
                                                               {"Right Alt", "Alt Gr"},
                                                               {"Menu", "Menü"},
                                                               {"Left Bumper", "Schulter links"},
                                                               {"Right Bumper", "Schulter rechts"},
                                                               {"Left Stick", "Stick links"},
                                                               {"Right Stick", "Stick rechts"},
                                                               {"Back", "Zurück"},
                                                               {"Up", "oben"},
                                                               {"Down", "unten"},
                                                               {"Left", "links"},
                                                               {"Right", "rechts"},
                                                               {"Enter", "Eingabe"}};

constexpr const char* kKeypad = "Keypad ";

constexpr std::pair<const char*, const char*> kLanguageNames[] = {
    {"bg", "Български"}, {"cs", "Čeština"},       {"da", "Dansk"},      {"de", "Deutsch"},    {"el", "Ελληνικά"},
    {"en", "English"},   {"es", "Español"},       {"et", "Eesti"},      {"fi", "Suomi"},      {"fr", "Français"},
    {"hr", "Hrvatski"},  {"hu", "Magyar"},        {"it", "Italiano"},   {"la", "Latina"},     {"lt", "Lietuvių"},
    {"lv", "Latviešu"},  {"nds", "Plattdüütsch"}, {"nl", "Nederlands"}, {"no", "Norsk"},      {"pl", "Polski"},
    {"pt", "Português"}, {"ro", "Română"},        {"ru", "Русский"},    {"sk", "Slovenčina"}, {"sl", "Slovenščina"},
    {"sv", "Svenska"},   {"tr", "Türkçe"},        {"uk", "Українська"}};

bool IsGerman(const std::string& language) { return language == "de" || language.rfind("de-", 0) == 0; }
const char* In(const Words& words, const std::string& language) { return IsGerman(language) ? words.de : words.en; }

}  // namespace

const char* Say(Phrase phrase, const std::string& language) {
  return In(kPhrases[static_cast<size_t>(phrase)], language);
}
const char* NameOf(Action action, const std::string& language) {
  return In(kActionWords[static_cast<size_t>(action)], language);
}

std::string KeyName(const std::string& label, const std::string& language) {
  if (label.rfind(kKeypad, 0) == 0) {
    const std::string key = label.substr(std::string(kKeypad).size());
    return "Num " + (key == "Subtract" ? "-" : key == "Add" ? "+" : KeyName(key, language));
  }
  if (!IsGerman(language)) return label;
  for (const auto& [en, de] : kGermanKeys) {
    if (label == en) return de;
  }
  return label;
}

const std::vector<std::string>& PhraseLanguages() {
  static const std::vector<std::string> languages{"en", "de"};
  return languages;
}

std::string LanguageName(const std::string& language) {
  for (const auto& [code, name] : kLanguageNames) {
    if (language == code) return name;
  }
  return language;
}

}  // namespace flaneur
