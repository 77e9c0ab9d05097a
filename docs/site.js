// SPDX-License-Identifier: MIT
// A browser gives a page that was opened from a file neither a worker nor the text of another file, so that the search of the site would
// not work without a server. Then this takes the worker's place: it loads lunr and search/index.js (.mkdocs_hooks.py writes it) as
// scripts of the page, once something is looked for.
if (window.location.protocol === 'file:') {
  window.Worker = class {
    constructor(script) {
      this.folder = script.slice(0, -'worker.js'.length);
      this.documents = new Map();
    }
    postMessage(message) {
      if (message.init) setTimeout(() => this.onmessage({data: {allowSearch: true}}), 0);
      else this.ready().then(() => this.onmessage({data: {results: this.search(message.query)}}));
    }
    ready() {
      const load = name => new Promise((done, failed) => {
        const script = document.createElement('script');
        script.src = this.folder + name, script.onload = done, script.onerror = failed;
        document.head.appendChild(script);
      });
      return this.begun ||= load('lunr.js').then(() => load('index.js')).then(() => {
        const {config, docs} = window.searchIndex, documents = this.documents;
        lunr.tokenizer.separator = new RegExp(config.separator);
        this.index = lunr(function () {
          this.field('title'), this.field('text'), this.ref('location');
          for (const one of docs) this.add(one), documents.set(one.location, one);
        });
      });
    }
    search(query) {
      return this.index.search(query).map(found => this.documents.get(found.ref))
        .map(one => ({location: one.location, title: one.title, summary: one.text.substring(0, 200)}));
    }
  };
  window.min_search_length = 2;  // letters that are too few, as in the configuration of mkdocs
}
