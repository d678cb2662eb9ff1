#include "robot/interaction/words.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace robot {
namespace {

Text both(std::string en, std::string de) { return {{"en", std::move(en)}, {"de", std::move(de)}}; }

std::string in_language(const Text& text, const std::string& language) {
  if (const auto it = text.find(language); it != text.end()) return it->second;
  const auto en = text.find("en");
  return en == text.end() ? std::string() : en->second;
}

// Goal of the sentence: an exhibit's phrase, or the place on the map.
Text to_goal(const Status& status, const Museum& museum) {
  const Exhibit* exhibit = find_exhibit(museum, status.exhibit);
  if (!exhibit) return both("to the place that was picked on the map", "zu dem Ort, der auf dem Plan gewählt wurde");
  Text to = exhibit->to;
  to.try_emplace("en", "to “" + in_language(exhibit->title, "en") + "”");
  to.try_emplace("de", "zu „" + in_language(exhibit->title, "de") + "“");
  return to;
}

Text about_goal(const Status& status, const Museum& museum) {
  const Exhibit* exhibit = find_exhibit(museum, status.exhibit);
  if (!exhibit) return both("about this place", "etwas über diesen Ort");
  Text about = exhibit->about;
  about.try_emplace("en", "about “" + in_language(exhibit->title, "en") + "”");
  about.try_emplace("de", "etwas über „" + in_language(exhibit->title, "de") + "“");
  return about;
}

std::string count_en(int people) {
  static const char* const words[] = {"nobody",      "one person",  "two people", "three people",
                                      "four people", "five people", "six people"};
  return people <= 6 ? words[std::max(people, 0)] : std::to_string(people) + " people";
}
std::string count_de(int people) {
  static const char* const words[] = {"niemand",    "jemand",     "zwei Leute", "drei Leute",
                                      "vier Leute", "fünf Leute", "sechs Leute"};
  return people <= 6 ? words[std::max(people, 0)] : std::to_string(people) + " Leute";
}

Text waiting_sentence(const Status& status) {
  const int people = std::max(status.people_near, 1);
  if (status.why == Why::way_blocked) {
    return both("The way is blocked, I am looking for another one.", "Der Weg ist versperrt, ich suche einen anderen.");
  }
  return both("I am waiting for " + count_en(people) + " to make way.",
              people == 1 ? "Ich warte, bis mich jemand durchlässt."
                          : "Ich warte, bis " + count_de(people) + " mich durchlassen.");
}

Text fault_sentence(const Status& status) {
  switch (status.why) {
    case Why::laser_silent:
      return both("I stand still because my laser is silent. Staff are coming.",
                  "Ich bleibe stehen, weil mein Laser schweigt. Das Personal kommt.");
    case Why::base_silent:
      return both("I stand still because my wheels do not answer. Staff are coming.",
                  "Ich bleibe stehen, weil meine Räder nicht antworten. Das Personal kommt.");
    case Why::bumped:
      return both("I have stopped because something touched me.", "Ich habe angehalten, weil mich etwas berührt hat.");
    case Why::emergency_stop:
      return both("I stand still because my emergency button is pressed.",
                  "Ich bleibe stehen, weil mein Not-Aus gedrückt ist.");
    case Why::motors_off:
      return both("I stand still because my motors are off.", "Ich bleibe stehen, weil meine Motoren aus sind.");
    case Why::hazard_near:
      return both("I stand still: I do not know well enough how far away the danger is.",
                  "Ich bleibe stehen: Ich weiß nicht genau genug, wie weit die Gefahr weg ist.");
    default:
      return both("I stand still because something is wrong. Staff are coming.",
                  "Ich bleibe stehen, weil etwas nicht stimmt. Das Personal kommt.");
  }
}

}  // namespace

Text spoken_duration(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0) seconds = 0.0;
  if (seconds < 90.0) {
    const int s = std::max(5, static_cast<int>(std::lround(seconds / 5.0)) * 5);
    return both("about " + std::to_string(s) + " s", "etwa " + std::to_string(s) + " s");
  }
  const int minutes = static_cast<int>(std::lround(seconds / 60.0));
  return both(std::to_string(minutes) + " min", std::to_string(minutes) + " min");
}

Text status_sentence(const Status& status, const Museum& museum) {
  if (status.why == Why::recording) {
    return both("You are watching a drive that was recorded earlier.",
                "Du siehst eine Fahrt, die früher aufgezeichnet wurde.");
  }
  switch (status.activity) {
    case Activity::starting:
      return both("I am waking up and listen to my sensors.", "Ich wache auf und horche auf meine Sensoren.");
    case Activity::localizing:
      return both("I am not sure where I am and look around.", "Ich weiß nicht genau, wo ich bin, und schaue mich um.");
    case Activity::idle:
      return both("I am looking for someone who would like a tour.", "Ich suche jemanden, der eine Tour möchte.");
    case Activity::homing:
      return both("I am going back to my place.", "Ich fahre zurück an meinen Platz.");
    case Activity::driving: {
      const Text to = to_goal(status, museum);
      return both("I am on my way " + in_language(to, "en") + ".", "Ich bin unterwegs " + in_language(to, "de") + ".");
    }
    case Activity::waiting:
      return waiting_sentence(status);
    case Activity::explaining: {
      if (status.exhibit.empty()) return both("I have arrived.", "Ich bin angekommen.");
      const Text about = about_goal(status, museum);
      return both("I am telling you " + in_language(about, "en") + ".",
                  "Ich erzähle euch " + in_language(about, "de") + ".");
    }
    case Activity::asking:
      return both("More about this, or shall we move on?", "Mehr davon, oder gehen wir weiter?");
    case Activity::stopped:
      return both("A member of staff has stopped me.", "Jemand vom Personal hat mich angehalten.");
    case Activity::faulted:
      return fault_sentence(status);
  }
  return {};
}

Text status_detail(const Status& status, const Museum& museum) {
  if (status.why == Why::recording) {
    return both("The plan shows where the robot believes to be, and what its laser saw.",
                "Der Plan zeigt, wo der Roboter zu sein glaubt und was sein Laser sah.");
  }
  std::string en, de;
  const auto add = [&](const std::string& more_en, const std::string& more_de) {
    en += (en.empty() ? "" : " ") + more_en;
    de += (de.empty() ? "" : " ") + more_de;
  };
  const bool under_way = status.activity == Activity::driving || status.activity == Activity::waiting;
  if (const Tour* tour = find_tour(museum, status.tour); tour && status.stop_count > 0) {
    const std::string of = std::to_string(status.stop_number), all = std::to_string(status.stop_count);
    add("Tour “" + in_language(tour->title, "en") + "”, stop " + of + " of " + all + ".",
        "Tour „" + in_language(tour->title, "de") + "“, Station " + of + " von " + all + ".");
  }
  if (status.activity == Activity::waiting) {
    const Text to = to_goal(status, museum);
    add("On the way " + in_language(to, "en") + ".", "Auf dem Weg " + in_language(to, "de") + ".");
  }
  if (!status.requester.empty() && (under_way || status.activity == Activity::explaining)) {
    add("For " + status.requester + ".", "Für " + status.requester + ".");
  }
  if (under_way && status.distance_to_go > 0.5) {
    const auto metres = std::to_string(static_cast<int>(std::lround(status.distance_to_go)));
    const Text time = spoken_duration(status.seconds_to_go);
    add(metres + " m to go, " + in_language(time, "en") + ".",
        "Noch " + metres + " m, " + in_language(time, "de") + ".");
  }
  if (status.activity == Activity::explaining && status.seconds_to_go > 0.0) {
    const Text time = spoken_duration(status.seconds_to_go);
    add("I stay for " + in_language(time, "en") + ".", "Ich bleibe " + in_language(time, "de") + ".");
  }
  if (status.activity == Activity::driving && status.why == Why::crowded_slow) {
    add("I drive slowly because many people are near.", "Ich fahre langsam, weil viele Menschen da sind.");
  }
  if (status.activity == Activity::idle)
    add("Choose an exhibit, and I go there.", "Wähle ein Exponat, dann fahre ich hin.");
  return both(std::move(en), std::move(de));
}

}  // namespace robot
