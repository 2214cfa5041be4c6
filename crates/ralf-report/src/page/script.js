// Shows one sequence and one scan at a time; without this script all of them are shown.
(() => {
  const [sequencePicker, scanPicker] = ["pick-sequence", "pick-scan"].map((id) => document.getElementById(id));
  const sequences = [...document.querySelectorAll("article.sequence")];
  const scansOf = (sequence) => [...sequence.querySelectorAll("figure.scan")];
  const show = (elements, chosen) =>
    elements.forEach((element, index) => element.classList.toggle("away", index !== chosen));
  const showScan = () => show(scansOf(sequences[sequencePicker.selectedIndex]), scanPicker.selectedIndex);
  const showSequence = () => {
    show(sequences, sequencePicker.selectedIndex);
    const names = scansOf(sequences[sequencePicker.selectedIndex]).map((scan) => new Option(scan.dataset.name));
    scanPicker.replaceChildren(...names);
    showScan();
  };
  if (sequences.length === 0) return;
  document.querySelector(".picker").hidden = false;
  sequencePicker.addEventListener("change", showSequence);
  scanPicker.addEventListener("change", showScan);
  showSequence();
})();
