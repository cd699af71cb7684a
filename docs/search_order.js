/* Order the results of the search by the words of the query in titles, in headings, and in what a command does. */
"use strict";

const Order = {
  // Folders that readers want first have positive numbers; folders that few want have negative ones.
  folders: [
    [/^reference\/test-suite\//, -200],
    [/^reference\/(language|pymycobot)$/, -15],
    [/^contribute\//, -20],
    [/^guide\//, 6],
    [/^api\//, -10],
    [/^reference\/.*\/README$/, -5],
    [/^(reference|robots)\/mycobot280(\/|$)/, 6],
    [/^(reference|robots)\//, -8],
  ],

  /* Return the score of a result, and make it lead to the section that fits the query best. */
  score: (item) => {
    const folder = Order.folders.find(([pattern]) => pattern.test(item[0]))?.[1] ?? 0;
    if (item[6] === "object") return folder - 15 + Order.fit(Order.words(item[1]));
    const page = Search._index.docnames.indexOf(item[0]);
    const title = Search._index.titles[page];
    const ofPage = Order.words(title);
    let best = Order.fit(ofPage);
    item.splice(1, 3, title, "", null);
    for (const { heading, anchor, does, main, own, further } of Order.sections.get(page) ?? []) {
      const fit = Order.fit(own, ofPage, further) + main;
      if (fit <= best) continue;
      best = fit;
      item.splice(1, 3, `${title} > ${heading}`, anchor, does);
    }
    return folder + best;
  },

  /* Return how well words fit the query: the more further words there are, the lower. */
  fit: (own, ...others) => {
    const query = [...Order.query];
    const mine = query.filter((word) => own.has(word)).length;
    const found = query.filter((word) => own.has(word) || others.some((set) => set.has(word))).length;
    return (70 * found + 20 * mine) / query.length + (10 * mine) / Math.max(own.size, 1);
  },

  words: (text) => {
    const words = splitQuery(text.toLowerCase()).filter((word) => !stopwords.has(word));
    return new Set(words.map((word) => Order.stemmer.stemWord(word)));
  },

  get stemmer() { return (Order._stemmer ??= new Stemmer()); },

  /* The words of the query without "arm", which is on every page. */
  get query() {
    const words = () => Order.words(new URLSearchParams(location.search).get("q") ?? "");
    return (Order._query ??= words().difference(new Set(["arm"])));
  },

  /* The sections of each page. That of a command states what the command does, and whether the command has a role. */
  get sections() {
    if (Order._sections) return Order._sections;
    const commands = new Map();
    for (const [entry, places] of Object.entries(Search._index.indexentries))
      for (const [page, anchor, main] of places) commands.set(`${page}#${anchor}`, [entry, main]);
    Order._sections = new Map(Search._index.docnames.map((_, page) => [page, []]));
    for (const [heading, places] of Object.entries(Search._index.alltitles))
      for (const [page, id] of places) {
        if (id === null) continue;
        const [entry, main] = commands.get(`${page}#${id}`) ?? ["", false];
        const [does, more] = entry.split(" | ");
        const section = { heading, anchor: `#${id}`, does: does || null, main: main ? 10 : 0 };
        section.own = Order.words(`${heading} ${does}`);
        section.further = Order.words(more ?? "");
        Order._sections.get(page).push(section);
      }
    return Order._sections;
  },
};

var Scorer = {
  score: Order.score,
  ...{ objNameMatch: 11, objPartialMatch: 6, objPrio: {}, objPrioDefault: 0 },
  ...{ title: 15, partialTitle: 7, term: 5, partialTerm: 2 },
};
