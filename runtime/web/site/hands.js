// Keys, mouse, touch and gamepad, as the player hears of them.
const kClick_px = 8, kClick_ms = 500;  // a press that moves or lasts longer turns the view
const kKeys = {
  Space: 'space', Escape: 'escape', Enter: 'enter', Backspace: 'backspace', ArrowRight: 'right', ArrowLeft: 'left',
  ArrowDown: 'down', ArrowUp: 'up', PageUp: 'page_up', PageDown: 'page_down', Home: 'home', End: 'end',
  ShiftLeft: 'left_shift', ShiftRight: 'right_shift', Comma: 'comma', Period: 'period', Minus: 'minus', Equal: 'equal',
  NumpadAdd: 'keypad_add', NumpadSubtract: 'keypad_subtract', NumpadEnter: 'keypad_enter'};
const kPadButtons = ['a', 'b', 'x', 'y', 'left_bumper', 'right_bumper', null, null, 'back', 'start', 'left_thumb',
                     'right_thumb', 'up', 'down', 'left', 'right'];

// Browsers tell of a gamepad from its first button on; who asks without one there may wait for a tenth of a second.
let gamepads = 0;
addEventListener('gamepadconnected', () => { ++gamepads; });
addEventListener('gamepaddisconnected', () => { --gamepads; });

// Tab stays with the page, so that the keyboard alone reaches its buttons, and the browser has its own F keys.
function nameOfKey(code) {
  const plain = /^(?:Key|Digit)(.)$/.exec(code);
  return plain ? plain[1].toLowerCase() : kKeys[code];
}

export class Hands {
  // pages: of pages.js. signal: of the visit.
  constructor(canvas, player, pages, signal) {
    Object.assign(this, {canvas, player, pages, signal, points: true, down: new Map(), began: null, held: {}});
    this.#takeKeys();
    this.#takePointers();
    this.#takeMouse();
  }
  // What the last picture showed.
  show(state) {
    this.points = state.points;
    if (this.points && document.pointerLockElement === this.canvas) document.exitPointerLock();
  }

  #on(event, type, take, options = {}) {
    event.addEventListener(type, take, {signal: this.signal, ...options});
  }
  #key(name, down) {
    this.player.do('page_key', ['string', 'number'], [name, down ? 1 : 0]);
  }
  #turn(x, y) {
    this.player.do('page_turn', ['number', 'number'], [x, y]);
  }
  #takeKeys() {
    this.#on(window, 'keydown', (e) => {
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (!this.pages.waitsForKey() && e.target.closest?.('button, select, input, a, dialog')) return;
      const key = nameOfKey(e.code);
      if (!key || (key === 'escape' && document.fullscreenElement)) return;
      this.#key(key, true);
      e.preventDefault();
    }, {capture: true});
    this.#on(window, 'keyup', (e) => {
      const key = nameOfKey(e.code);
      if (key) this.#key(key, false);
    });
    this.#on(window, 'blur', () => this.player.do('page_release_keys'));
    this.#on(document, 'visibilitychange', () => this.player.do('page_release_keys'));
  }
  #apart() {
    const [a, b] = [...this.down.values()];
    return Math.hypot(a.x - b.x, a.y - b.y);
  }
  // Dragging takes the picture along, a tap or click walks there, two fingers or the wheel widen the view.
  #takePointers() {
    const canvas = this.canvas, on = (type, take, options) => this.#on(canvas, type, take, options);
    on('pointerdown', (e) => {
      if (e.button !== 0 || this.#isLocked()) return;
      try {
        canvas.setPointerCapture(e.pointerId);
      } catch {
        return;  // the browser is about to catch the pointer for good, as the last click has asked
      }
      this.down.set(e.pointerId, {x: e.clientX, y: e.clientY});
      this.began = this.down.size === 1 ? {x: e.clientX, y: e.clientY, time: e.timeStamp} : null;
      canvas.focus();
    });
    on('pointermove', (e) => {
      const was = this.down.get(e.pointerId);
      if (!was) return;
      const before = this.down.size === 2 ? this.#apart() : 0;
      this.down.set(e.pointerId, {x: e.clientX, y: e.clientY});
      if (this.began && Math.hypot(e.clientX - this.began.x, e.clientY - this.began.y) > kClick_px) this.began = null;
      if (this.down.size === 2 && before > 0 && this.#apart() > 0) this.#widen(before / this.#apart());
      const along = this.points ? 1 : -1;  // a caught mouse takes the eye along, a finger always the picture
      if (this.down.size === 1 && !this.began) this.#turn(along * (e.clientX - was.x), along * (e.clientY - was.y));
    });
    const up = (e) => {
      const isClick = e.type === 'pointerup' && this.began && this.down.size === 1 && e.timeStamp - this.began.time < kClick_ms;
      if (isClick && !this.#lock(e)) {
        const box = canvas.getBoundingClientRect();
        this.#click((e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height);
      }
      this.down.delete(e.pointerId);
      this.began = null;
    };
    on('pointerup', up);
    on('pointercancel', up);
    on('wheel', (e) => {
      this.#widen(Math.exp(Math.sign(e.deltaY) * 0.05));
      e.preventDefault();
    }, {passive: false});
    on('contextmenu', (e) => {
      e.preventDefault();
      this.player.do('page_ask', ['string'], ['menu']);
    });
  }
  #widen(factor) {
    this.player.do('page_widen', ['number'], [factor]);
  }
  #click(x, y) {
    this.player.do('page_click', ['number', 'number'], [x, y]);
  }
  #isLocked() {
    return document.pointerLockElement === this.canvas;
  }
  // Where the settings have the mouse turn the view, the first click catches it; Esc frees it.
  #lock(e) {
    if (this.points || e.pointerType !== 'mouse' || !this.canvas.requestPointerLock) return false;
    Promise.resolve(this.canvas.requestPointerLock()).catch(() => {});
    return true;
  }
  #takeMouse() {
    this.#on(document, 'mousemove', (e) => this.#isLocked() && this.#turn(e.movementX, e.movementY));
    this.#on(this.canvas, 'mousedown', (e) => this.#isLocked() && e.button === 0 && this.#click(0.5, 0.5));
    this.signal.addEventListener('abort', () => this.#isLocked() && document.exitPointerLock());
  }
  // Once a picture.
  takeGamepad() {
    if (gamepads === 0) return;
    const pad = navigator.getGamepads().find((p) => p?.mapping === 'standard');
    if (!pad) return;
    pad.buttons.forEach((button, k) => {
      const name = kPadButtons[k];
      if (!name || button.pressed === (this.held[k] ?? false)) return;
      this.held[k] = button.pressed;
      if (button.pressed && this.pages.takePad(name)) return;
      this.#key('pad_' + name, button.pressed);
    });
    const [lx, ly, rx, ry] = pad.axes;
    this.player.do('page_sticks', ['number', 'number', 'number', 'number'], [lx, -ly, rx, -ry]);
  }
}
