// SPDX-License-Identifier: BSD-3-Clause
//
// What scripts (and tests) may do with the page: window.tegl. What they ask for is looked at first: an Error names the
// value and what was expected, and leaves the page as it is.

const shown = (value) => (typeof value === 'string' ? `'${value}'` : Array.isArray(value) ? `[${value.map(shown)}]`
  : value !== null && typeof value === 'object' ? 'an object' : typeof value === 'function' ? 'a function' : String(value));

function expect(isRight, call, value, expected) {
  if (!isRight) throw new Error(`tegl.${call}: ${shown(value)}; expected ${expected}`);
}

const listed = (names) => names.map((name) => `'${name}'`).join(', ');

export function interfaceOf(app) {
  const needsTime = (call) => {
    if (!app.timeline) throw new Error(`tegl.${call}: the page has no time; expected a page with a 4D contour`);
  };
  return {
    get time() { return app.t; },
    /** A time of the data; one beyond the range is taken as the nearer end of it. */
    set time(t) {
      needsTime('time');
      expect(Number.isFinite(t), 'time', t, `a number, from ${app.first} to ${app.last}`);
      app.setTime(t);
    },
    get range() {
      return [app.first, app.last];
    },
    /** Simplices shown, before clipping: for 4D contours the triangles of tegl slice at this time. */
    count: () => app.count(),
    play: (isPlaying = true) => {
      needsTime('play');
      expect(typeof isPlaying === 'boolean', 'play', isPlaying, 'true or false');
      app.play(isPlaying);
    },
    colorBy: (id) => {
      const ids = app.current.sources().map((source) => source.id);
      expect(ids.includes(id), 'colorBy', id, `one of ${listed(ids)}`);
      app.colorBy(id);
    },
    colorings: () => app.current.sources().map(({id}) => id),
    /** Shows what lies from a share of an axis' range to another alone. */
    clip: (axis, from, to) => {
      const { axes } = app.stage;
      const isShare = (share) => Number.isFinite(share) && share >= 0 && share <= 1;
      expect(Number.isInteger(axis) && axis >= 0 && axis < axes.length, 'clip', axis,
        `an axis, 0 to ${axes.length - 1} (${axes.map(({ name }) => name).join(', ')})`);
      expect(isShare(from) && isShare(to) && from <= to, 'clip', [from, to],
        'two fractions of the axis from 0 to 1, the lower one first');
      app.panel.setClip(axis, from, to);
    },
    theme: (theme) => {
      const themes = ['light', 'dark'];
      expect(themes.includes(theme), 'theme', theme, listed(themes));
      app.setTheme(theme);
    },
    picture: () => app.picture(),
    /** Draws now; gives how many tetrahedra were drawn, in how many ranges. */
    draw: () => {
      app.stage.render();
      return app.inTime.map((layer) => ({ tetrahedra: layer.drawn, ranges: layer.ranges }));
    },
    get frames() { return app.stage.frames; },
    app,
  };
}
