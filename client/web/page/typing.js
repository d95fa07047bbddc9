// What the player types into a field of a window. The window is drawn on the canvas, for which no
// phone opens its keyboard and to which no input method writes. So a text field of the page that
// nobody sees has the focus meanwhile, and every change of its text is passed on as keys and
// characters.
"use strict";

const Typing = (() => {
  // The field is never empty, because the key for deleting changes nothing in an empty field.
  const START = "\u200b";
  const field = document.getElementById("typed");
  let isOpen = false; // a field of a window has the keyboard
  let known = START; // the text of the field of which the program knows

  // Returns true for a key whose text arrives later, as a change of the field: the keyboards of
  // phones and input methods report such keys.
  const writesLater = (event) => event.isComposing || event.keyCode === 229 || event.key === "Dead";

  function reset() {
    field.value = known = START;
  }
  function pressDelete() {
    for (const isPressed of [1, 0]) Program.call("web_key", "Backspace", "Backspace", isPressed, 0, 0, 0);
  }
  function passChange(event) {
    const [before, after] = [[...known], [...field.value]];
    let same = 0;
    while (same < before.length && before[same] === after[same]) ++same;
    before.slice(same).forEach(pressDelete);
    for (const character of after.slice(same)) Program.call("web_character", character.codePointAt(0));
    known = field.value;
    if (!event.isComposing) reset(); // a reset would end the composition of a word
  }

  // Gives the keyboard of the page to the field, or to the world if no window has the keyboard.
  function focus() {
    (isOpen ? field : document.getElementById("canvas")).focus();
  }
  // A field of a window has the keyboard from now on, or none has.
  function set(isOpenNow) {
    isOpen = isOpenNow;
    field.hidden = !isOpen;
    reset();
    focus();
  }
  // A touch on a window ended here. The browser scrolls the place of the field into sight when the
  // keyboard opens. The keyboard may have been closed by hand, and some browsers open it only in the
  // event of a touch.
  function touched(x, y) {
    field.style.left = `${x}px`;
    field.style.top = `${y}px`;
    if (!isOpen) return;
    field.blur();
    field.focus();
  }

  field.addEventListener("input", passChange);
  // Some browsers report the end of a composition before its last change, and others after it.
  field.addEventListener("compositionend", passChange);
  return { field, writesLater, focus, set, touched };
})();
