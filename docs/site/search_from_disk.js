// A stand-in for Worker in pages opened from the disk, where browsers start none: the script runs in a hidden frame.
window.Worker = class extends EventTarget {
  constructor(url) {
    super();
    const frame = document.createElement("iframe");
    frame.hidden = true;
    document.documentElement.append(frame);
    this.inside = frame.contentWindow;
    window.addEventListener("message", (event) => {
      if (event.source === this.inside) {
        this.dispatchEvent(new MessageEvent("message", { data: event.data }));
      }
    });
    this.ready = new Promise((resolve) => {
      const page = this.inside.document;
      this.inside.importScripts = (...scripts) =>
        scripts.reduce((before, script) => before.then(() => this.load(script)), Promise.resolve());
      page.open();
      page.write("<script>window.postMessage = (data) => parent.postMessage(data, '*')</script>");
      page.close();
      this.load(url).then(resolve);
    });
  }
  load(script) {
    return new Promise((resolve) => {
      const element = this.inside.document.createElement("script");
      element.src = script;
      element.onload = resolve;
      this.inside.document.documentElement.append(element);
    });
  }
  postMessage(data) {
    this.ready.then(() => this.inside.dispatchEvent(new MessageEvent("message", { data })));
  }
};
